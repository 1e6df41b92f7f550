#include "streaming/http/http_fetcher.h"

#include <algorithm>
#include <cassert>
#include <mutex>
#include <thread>
#include <utility>
#include <variant>

#include "streaming/http/network.h"

namespace terrella {
namespace {

struct Rank {
  std::uint64_t id = 0;
  double priority = 0.0;
};
struct Cancel {
  std::uint64_t id = 0;
};
using Command = std::variant<HttpRequest, Rank, Cancel>;

// Rank changes do not wake the thread, because ranks matter only when a request is sent. More queued changes than this
// do wake it.
constexpr std::size_t kMaxUnread = 1024;

void begin_curl() {
  static const CURLcode begun = curl_global_init(CURL_GLOBAL_DEFAULT);
  assert(begun == CURLE_OK);
  static_cast<void>(begun);
}

// Values beyond their ranges count as the nearest end, and a rate or burst that is no number as the default.
HttpOptions within_ranges(HttpOptions options) {
  using std::chrono::milliseconds;
  options.connections_per_host = std::clamp(options.connections_per_host, 1, 64);
  options.in_flight_per_host = std::clamp(options.in_flight_per_host, 1, 1024);
  options.attempts = std::clamp(options.attempts, 1, 20);
  options.max_redirects = std::max(options.max_redirects, 0);
  if (!(options.rate_per_host >= 0.0)) options.rate_per_host = HttpOptions().rate_per_host;
  if (!(options.burst >= 1.0)) options.burst = HttpOptions().burst;
  options.first_backoff = std::max(options.first_backoff, milliseconds(0));
  options.longest_backoff = std::max(options.longest_backoff, milliseconds(0));
  return options;
}

}  // namespace

struct HttpFetcher::Impl {
  Impl(const HttpOptions& options, ReplyQueue& replies)
      : network((begin_curl(), within_ranges(options)), replies, tally), thread([this] { run(); }) {}
  ~Impl() {
    {
      const std::lock_guard lock(mutex);
      stopping = true;
    }
    network.wake();
    thread.join();
  }

  // thread: any -----------------------------------------------------------------------------------------------------
  void push(Command&& command, bool urgent);

  // thread: network -------------------------------------------------------------------------------------------------
  void run();
  [[nodiscard]] bool take_commands();
  void apply(Command&& command);

  const std::shared_ptr<http::HttpTally> tally = std::make_shared<http::HttpTally>();
  http::Network network;
  std::mutex mutex;  ///< guards the three members below
  std::vector<Command> inbox;
  bool woken = false;
  bool stopping = false;
  std::vector<Command> taken;  ///< thread: network
  std::thread thread;
};

void HttpFetcher::Impl::push(Command&& command, bool urgent) {
  bool wake = false;
  {
    const std::lock_guard lock(mutex);
    inbox.push_back(std::move(command));
    wake = !woken && (urgent || inbox.size() >= kMaxUnread);
    if (wake) woken = true;
  }
  if (wake) network.wake();
}

bool HttpFetcher::Impl::take_commands() {
  {
    const std::lock_guard lock(mutex);
    if (stopping) return false;
    taken.swap(inbox);
    woken = false;
  }
  for (Command& command : taken) apply(std::move(command));
  taken.clear();
  return true;
}

void HttpFetcher::Impl::apply(Command&& command) {
  if (auto* request = std::get_if<HttpRequest>(&command)) {
    network.submit(std::move(*request));
  } else if (const auto* rank = std::get_if<Rank>(&command)) {
    network.set_priority(rank->id, rank->priority);
  } else if (const auto* cancelled = std::get_if<Cancel>(&command)) {
    network.cancel(cancelled->id);
  }
}

void HttpFetcher::Impl::run() {
  while (take_commands()) {
    if (!network.turn()) network.wait();
  }
}

HttpFetcher::HttpFetcher(const HttpOptions& options, ReplyQueue& replies) {
  impl_ = std::make_unique<Impl>(options, replies);
}

HttpFetcher::~HttpFetcher() = default;

void HttpFetcher::submit(HttpRequest request) {
  ++impl_->tally->waiting;
  impl_->push(std::move(request), true);
}

void HttpFetcher::set_priority(std::uint64_t id, double priority) { impl_->push(Rank{id, priority}, false); }

void HttpFetcher::cancel(std::uint64_t id) { impl_->push(Cancel{id}, true); }

HttpCounts HttpFetcher::counts() const {
  const http::HttpTally& tally = *impl_->tally;
  return {.waiting = tally.waiting,
          .in_flight = tally.in_flight,
          .requests = tally.requests,
          .retries = tally.retries,
          .body_bytes = tally.body_bytes};
}

}  // namespace terrella
