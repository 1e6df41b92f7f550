#include "streaming/http/network.h"

#include <algorithm>
#include <cassert>

#include "streaming/file_bytes.h"

namespace terrella::http {
namespace {

using std::chrono::milliseconds;

constexpr std::size_t kMaxIdleTransfers = 128;
constexpr std::size_t kMaxHosts = 256;  // redirects may name any number of hosts
constexpr int kFilesPerTurn = 16;       // few, so that a new view is noticed soon
constexpr milliseconds kLongestSleep{1000};
// A new connection costs about as much as the rest of a tile. Waiting longer for an abandoned answer is not worth the
// slot.
constexpr milliseconds kAbandonedLife{500};

HostLimits limits_of(const HttpOptions& options) {
  return {.connections = options.connections_per_host,
          .in_flight = options.in_flight_per_host,
          .rate_per_s = options.rate_per_host,
          .burst = options.burst};
}

/// Reason why a request cannot be sent; empty if it can. Contains no header values.
std::string fault_of(const HttpRequest& request) {
  for (const std::string& header : request.headers) {
    if (const Status status = check_request_header(header); !status) return status.error().message;
  }
  const bool good =
      is_field_value(request.etag) && is_field_value(request.if_match) && is_field_value(request.last_modified);
  return good ? std::string() : "an entity tag or date to ask with holds a control character";
}

}  // namespace

Network::Network(const HttpOptions& options, ReplyQueue& replies, std::shared_ptr<HttpTally> tally)
    : options_(options),
      replies_(replies),
      tally_(std::move(tally)),
      multi_(curl_multi_init()),
      now_(std::chrono::steady_clock::now()) {
  if (!multi_) throw std::bad_alloc();
  curl_multi_setopt(multi_.get(), CURLMOPT_PIPELINING, CURLPIPE_MULTIPLEX);
  curl_multi_setopt(multi_.get(), CURLMOPT_MAX_HOST_CONNECTIONS, static_cast<long>(options.connections_per_host));
  curl_multi_setopt(multi_.get(), CURLMOPT_MAXCONNECTS, 4L * options.connections_per_host);
}

Network::~Network() {
  for (auto& [id, job] : jobs_) static_cast<void>(detach(*job));
  for (auto& job : abandoned_) static_cast<void>(detach(*job));
}

// Requests come in ------------------------------------------------------------------------------------------------

void Network::submit(HttpRequest&& request) {
  auto owned = std::make_unique<Job>();
  Job& job = *owned;
  job.request = std::move(request);
  job.sequence = submitted_++;
  const auto [entry, is_new] = jobs_.try_emplace(job.request.id, std::move(owned));
  assert(is_new);
  if (!is_new) return;
  Result<Address> address = parse_http_address(job.request.url);
  if (!address) return reply(job, HttpOutcome::refused, 0, address.error().message);
  job.address = std::move(*address);
  assert(!job.request.range || job.request.range->length > 0);
  std::string fault = fault_of(job.request);
  if (job.request.range && job.address.scheme == Address::Scheme::file) fault = "files are not read by ranges";
  if (!fault.empty()) return reply(job, HttpOutcome::refused, 0, shown(job.address) + ": " + fault);
  enqueue(job);
}

void Network::set_priority(std::uint64_t id, double priority) {
  const auto found = jobs_.find(id);
  if (found == jobs_.end()) return;
  Job& job = *found->second;
  if (job.state != Job::State::ready) {
    job.request.priority = priority;
    return;
  }
  auto node = job.host->ready.extract(&job);
  job.request.priority = priority;
  job.host->ready.insert(std::move(node));
}

void Network::cancel(std::uint64_t id) {
  const auto found = jobs_.find(id);
  if (found == jobs_.end()) return;
  Job& job = *found->second;
  if (job.state == Job::State::in_flight) return abandon(remove(job));
  static_cast<void>(remove(job));
  --tally_->waiting;
}

// Over HTTP/2 a single stream can be ended. Over HTTP/1.1 the connection would end too.
void Network::abandon(std::unique_ptr<Job> job) {
  --tally_->in_flight;
  if (job->host->gate.multiplexes()) return end_early(*job);
  job->state = Job::State::abandoned;
  job->due = std::chrono::steady_clock::now() + kAbandonedLife;
  abandoned_.push_back(std::move(job));
}

Host& Network::host_of(const std::string& origin) {
  const auto found = hosts_.find(origin);
  if (found != hosts_.end()) return found->second;
  if (hosts_.size() >= kMaxHosts) forget_idle_hosts();
  return hosts_.try_emplace(origin, limits_of(options_), now_).first->second;
}

void Network::forget_idle_hosts() {
  std::erase_if(hosts_, [this](const auto& entry) {
    const Host& host = entry.second;
    return host.jobs == 0 && host.gate.is_idle(now_) && !host.gate.is_given_up(now_);
  });
}

void Network::enqueue(Job& job) {
  if (job.host == nullptr) {
    job.host = &host_of(job.address.origin);
    ++job.host->jobs;
  }
  if (job.host->gate.is_given_up(now_)) return reply_given_up(job);
  job.state = Job::State::ready;
  job.host->ready.insert(&job);
}

void Network::dequeue(Job& job) {
  if (job.state == Job::State::ready && job.host != nullptr) job.host->ready.erase(&job);
  if (job.state == Job::State::delayed) delayed_.erase(&job);
}

void Network::leave_host(Job& job) {
  if (job.host == nullptr) return;
  --job.host->jobs;
  job.host = nullptr;
}

std::unique_ptr<Job> Network::remove(Job& job) {
  dequeue(job);
  auto node = jobs_.extract(job.request.id);
  return std::move(node.mapped());
}

// Requests go out -------------------------------------------------------------------------------------------------

bool Network::turn() {
  now_ = std::chrono::steady_clock::now();
  release_due();
  end_abandoned();
  for (auto& [origin, host] : hosts_) {
    if (!host.ready.empty()) send_ready(host);
  }
  int running = 0;
  curl_multi_perform(multi_.get(), &running);
  return collect();
}

void Network::release_due() {
  while (!delayed_.empty() && (*delayed_.begin())->due <= now_) {
    Job& job = **delayed_.begin();
    delayed_.erase(delayed_.begin());
    enqueue(job);
  }
}

void Network::end_abandoned() {
  std::erase_if(abandoned_, [this](const std::unique_ptr<Job>& job) {
    if (job->due > now_) return false;
    end_early(*job);
    return true;
  });
}

void Network::end_early(Job& job) {
  recycle(detach(job));
  job.host->gate.answered(false);
  leave_host(job);
}

void Network::send_ready(Host& host) {
  int files = 0;
  while (!host.ready.empty() && host.gate.is_open(now_) && files < kFilesPerTurn) {
    Job& job = **host.ready.begin();
    host.ready.erase(host.ready.begin());
    if (!job.is_hop) ++job.attempts;
    if (job.address.scheme == Address::Scheme::file) {
      ++files;
      reply_file(job);
    } else {
      send(job);
    }
  }
}

void Network::send(Job& job) {
  if (idle_.empty()) idle_.push_back(std::make_unique<Transfer>(options_));
  job.transfer = std::move(idle_.back());
  idle_.pop_back();
  const HostGate& gate = job.host->gate;
  const bool may_multiplex = !gate.is_known() || gate.multiplexes();
  job.transfer->begin({
      .url = &job.url(),
      .headers = job.may_send_headers ? &job.request.headers : nullptr,
      .etag = job.request.etag,
      .last_modified = job.request.last_modified,
      .if_match = job.request.if_match,
      .range = job.request.range,
      .wait_for_multiplexing = options_.http2 && job.address.scheme == Address::Scheme::https && may_multiplex,
  });
  curl_easy_setopt(job.transfer->handle(), CURLOPT_PRIVATE, &job);
  curl_multi_add_handle(multi_.get(), job.transfer->handle());
  job.host->gate.sent(now_);
  job.state = Job::State::in_flight;
  ++tally_->in_flight;
  --tally_->waiting;
  ++tally_->requests;
  if (job.attempts > 1 && !job.is_hop) ++tally_->retries;
  job.is_hop = false;
}

// A disk may be slow: who takes the reply reads the file.
void Network::reply_file(Job& job) {
  hand_over(job, begin_reply(job, HttpOutcome::content, 0),
            [path = job.address.path, most = options_.max_response_bytes, tally = tally_](HttpReply& reply) {
              auto bytes = read_file(path, most);
              if (!bytes) {
                const bool missing = bytes.error().problem == FileProblem::missing;
                reply.outcome = missing ? HttpOutcome::nothing : HttpOutcome::refused;
                reply.why = bytes.error().message;
                return;
              }
              reply.body = std::move(*bytes);
              tally->body_bytes += reply.body.size();
            });
}

std::unique_ptr<Transfer> Network::detach(Job& job) {
  if (job.transfer) curl_multi_remove_handle(multi_.get(), job.transfer->handle());
  return std::move(job.transfer);
}

void Network::recycle(std::unique_ptr<Transfer> transfer) {
  if (transfer && idle_.size() < kMaxIdleTransfers) idle_.push_back(std::move(transfer));
}

// Waiting ---------------------------------------------------------------------------------------------------------

Network::Time Network::next_event() const {
  Time next = now_ + kLongestSleep;
  for (const auto& [origin, host] : hosts_) {
    if (!host.ready.empty()) next = std::min(next, host.gate.opens_at(now_));
  }
  if (!delayed_.empty()) next = std::min(next, (*delayed_.begin())->due);
  for (const auto& job : abandoned_) next = std::min(next, job->due);
  return next;
}

void Network::wait() {
  const auto left = next_event() - std::chrono::steady_clock::now();
  const auto timeout = std::max(milliseconds(0), std::chrono::ceil<milliseconds>(left));
  curl_multi_poll(multi_.get(), nullptr, 0, static_cast<int>(timeout.count()), nullptr);
}

void Network::wake() { curl_multi_wakeup(multi_.get()); }

}  // namespace terrella::http
