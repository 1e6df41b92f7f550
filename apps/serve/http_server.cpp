#include "apps/serve/http_server.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <microhttpd.h>
#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <condition_variable>
#include <cstring>
#include <deque>
#include <exception>
#include <mutex>
#include <new>
#include <stop_token>
#include <thread>
#include <utility>
#include <vector>

namespace terrella {
namespace {

/// Limits on work in progress.
constexpr unsigned kIdleSeconds = 30;            // until a connection without traffic is closed
constexpr std::size_t kConnectionBytes = 16384;  // for a request's head; a longer head is refused
constexpr std::size_t kMostBytes = 256UL << 20;  // contents in memory that clients have not read yet
constexpr std::size_t kMostWaiting = 256;        // requests for tiles that are made, beside those being made
constexpr int kBacklog = 1024;

/// One request, from its first line until its answer is sent.
struct Exchange {
  std::string target;
  WebAnswer answer{};
  bool is_begun = false;
  bool is_answered = false;
};

WebAnswer too_busy() { return {.status = MHD_HTTP_SERVICE_UNAVAILABLE}; }

std::string_view field(MHD_Connection* connection, const char* name) {
  const char* value = MHD_lookup_connection_value(connection, MHD_HEADER_KIND, name);
  return value == nullptr ? std::string_view() : value;
}

/// True for a host with or without a port, which descriptions may repeat.
bool is_host(std::string_view host) {
  constexpr std::size_t kMost = 255;
  return !host.empty() && host.size() <= kMost &&
         std::ranges::all_of(host, [](char c) { return is_plain_in_addresses(c) || c == ':' || c == '[' || c == ']'; });
}

/// A socket that listens, and its address.
struct Listener {
  Descriptor socket;
  std::string address{};
  int port = 0;
  bool is_loopback = false;
};

const char* cure_of(int error_number) {
  if (error_number == EADDRINUSE)
    return "; end the program that listens there, or choose another port (0: any free one)";
  if (error_number == EACCES) return "; choose a port over 1023";
  if (error_number == EADDRNOTAVAIL) return "; name an address of this machine";
  return "";
}

/// Fills in the address that the system gave to a socket.
void describe(Listener& listener) {
  sockaddr_storage bound{};
  socklen_t size = sizeof bound;
  if (getsockname(listener.socket.number(), reinterpret_cast<sockaddr*>(&bound), &size) != 0) return;
  std::array<char, INET6_ADDRSTRLEN> text{};
  if (bound.ss_family == AF_INET6) {
    const auto& six = reinterpret_cast<const sockaddr_in6&>(bound);
    inet_ntop(AF_INET6, &six.sin6_addr, text.data(), text.size());
    listener.port = ntohs(six.sin6_port);
    listener.is_loopback = IN6_IS_ADDR_LOOPBACK(&six.sin6_addr);
    listener.address = fmt::format("http://[{}]:{}", text.data(), listener.port);
    return;
  }
  const auto& four = reinterpret_cast<const sockaddr_in&>(bound);
  inet_ntop(AF_INET, &four.sin_addr, text.data(), text.size());
  listener.port = ntohs(four.sin_port);
  listener.is_loopback = (ntohl(four.sin_addr.s_addr) >> 24) == IN_LOOPBACKNET;
  listener.address = fmt::format("http://{}:{}", text.data(), listener.port);
}

Result<Listener> listen_at(const HttpServerOptions& options) {
  const addrinfo hints{.ai_flags = AI_PASSIVE | AI_NUMERICSERV,
                       .ai_family = AF_UNSPEC,
                       .ai_socktype = SOCK_STREAM,
                       .ai_protocol = 0,
                       .ai_addrlen = 0,
                       .ai_addr = nullptr,
                       .ai_canonname = nullptr,
                       .ai_next = nullptr};
  addrinfo* found = nullptr;
  const int code = getaddrinfo(options.host.c_str(), std::to_string(options.port).c_str(), &hints, &found);
  if (code != 0) return Error{fmt::format("{}: {}; name an address of this machine", options.host, gai_strerror(code))};
  const std::unique_ptr<addrinfo, void (*)(addrinfo*)> all(found, freeaddrinfo);
  int why = 0;  // error of the last address tried
  for (const addrinfo* one = all.get(); one != nullptr; one = one->ai_next) {
    Listener listener{.socket = Descriptor(socket(one->ai_family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0))};
    const int descriptor = listener.socket.number(), on = 1;
    const bool listens = descriptor >= 0 && setsockopt(descriptor, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on) == 0 &&
                         bind(descriptor, one->ai_addr, one->ai_addrlen) == 0 && listen(descriptor, kBacklog) == 0;
    if (listens) {
      describe(listener);
      return listener;
    }
    why = errno;
    if (why == EADDRINUSE) break;  // else a second server of localhost would take the address that the first one left
  }
  return Error{fmt::format("{} port {}: {}{}", options.host, options.port, std::strerror(why), cure_of(why))};
}

void add_fields(MHD_Response* response, const WebAnswer& answer) {
  const auto add = [response](const char* name, const std::string& value) {
    if (!value.empty()) MHD_add_response_header(response, name, value.c_str());
  };
  add("Access-Control-Allow-Origin", "*");
  add("Content-Type", answer.type);
  add("ETag", answer.etag);
  // A client asks again each time, and 304 tells it that nothing has changed.
  if (!answer.etag.empty()) add("Cache-Control", "no-cache");
  add("Content-Range", answer.content_range);
  if (answer.file || !answer.content_range.empty()) {
    add("Accept-Ranges", "bytes");
    add("Access-Control-Expose-Headers", "ETag, Content-Range, Content-Length, Accept-Ranges");
  }
  if (answer.status == MHD_HTTP_METHOD_NOT_ALLOWED || answer.status == MHD_HTTP_NO_CONTENT) {
    add("Allow", "GET, HEAD, OPTIONS");
    add("Access-Control-Allow-Methods", "GET, HEAD, OPTIONS");
    add("Access-Control-Allow-Headers", "Range, If-Range, If-None-Match");
  }
  if (answer.status == MHD_HTTP_SERVICE_UNAVAILABLE) add("Retry-After", "1");
}

}  // namespace

class HttpServer::Work {
 public:
  Work(Listener listener, Answerer answerer) : listener_(std::move(listener)), answerer_(std::move(answerer)) {}
  Work(const Work&) = delete;
  Work& operator=(const Work&) = delete;

  ~Work() {
    for (std::jthread& maker : makers_) maker.request_stop();
    makers_.clear();
    {
      const std::lock_guard lock(mutex_);
      is_ending_ = true;
    }
    // A daemon that stops must have no suspended connections.
    for (const auto& [connection, exchange] : waiting_) finish(connection, *exchange, too_busy());
    if (daemon_ != nullptr) MHD_stop_daemon(daemon_);
  }

  [[nodiscard]] Status start(int connections) {
    const unsigned threads = std::max(2U, std::thread::hardware_concurrency());
    daemon_ = MHD_start_daemon(
        MHD_USE_EPOLL_INTERNAL_THREAD | MHD_USE_SUSPEND_RESUME, 0, nullptr, nullptr, on_request, this,
        MHD_OPTION_LISTEN_SOCKET, listener_.socket.number(), MHD_OPTION_THREAD_POOL_SIZE, threads,
        MHD_OPTION_CONNECTION_LIMIT, std::max(threads, static_cast<unsigned>(connections)),
        MHD_OPTION_CONNECTION_MEMORY_LIMIT, kConnectionBytes, MHD_OPTION_CONNECTION_TIMEOUT, kIdleSeconds,
        MHD_OPTION_URI_LOG_CALLBACK, on_target, this, MHD_OPTION_NOTIFY_COMPLETED, on_completed, this, MHD_OPTION_END);
    if (daemon_ == nullptr)
      return Error{listener_.address + ": the server cannot be started; give it more files or threads"};
    listener_.socket.release();  // closed by the daemon
    makers_.reserve(threads);
    for (unsigned i = 0; i < threads; ++i) {
      makers_.emplace_back([this](const std::stop_token& stop) { make_answers(stop); });
    }
    return Done{};
  }

  [[nodiscard]] const Listener& listener() const { return listener_; }

 private:
  /// Content that a client has not read yet.
  struct Held {
    Work* work;
    std::vector<std::byte> bytes;
  };

  // thread: a few of libmicrohttpd
  static void* on_target(void* /*self*/, const char* target, MHD_Connection* /*connection*/) {
    try {
      return new Exchange{.target = target};
    } catch (const std::bad_alloc&) {
      return nullptr;
    }
  }

  static void on_completed(void* /*self*/, MHD_Connection* /*connection*/, void** state,
                           MHD_RequestTerminationCode /*how*/) {
    delete static_cast<Exchange*>(*state);
    *state = nullptr;
  }

  static MHD_Result on_request(void* self, MHD_Connection* connection, const char* /*path*/, const char* method,
                               const char* /*version*/, const char* /*upload*/, std::size_t* /*upload_size*/,
                               void** state) {
    if (*state == nullptr) return MHD_NO;
    try {
      return static_cast<Work*>(self)->reply(connection, method, *static_cast<Exchange*>(*state));
    } catch (const std::exception&) {
      return MHD_NO;  // closes the connection
    }
  }

  [[nodiscard]] MHD_Result reply(MHD_Connection* connection, std::string_view method, Exchange& exchange) {
    // An answer to the first call, which has the request's head alone, ends the connection: right for one with a body.
    const bool has_body =
        !field(connection, "Content-Length").empty() || !field(connection, "Transfer-Encoding").empty();
    if (!std::exchange(exchange.is_begun, true) && !has_body) return MHD_YES;
    if (!exchange.is_answered) {
      const std::string_view host = field(connection, "Host");
      const std::string base = is_host(host) ? fmt::format("http://{}", host) : listener_.address;
      exchange.answer = answerer_({.method = method,
                                   .target = exchange.target,
                                   .base = base,
                                   .if_none_match = field(connection, "If-None-Match"),
                                   .range = field(connection, "Range"),
                                   .if_range = field(connection, "If-Range")});
      exchange.is_answered = true;
      if (exchange.answer.later && wait_for_maker(connection, exchange)) return MHD_YES;
      if (exchange.answer.later) exchange.answer = too_busy();
    }
    return send(connection, std::move(exchange.answer));
  }

  [[nodiscard]] MHD_Result send(MHD_Connection* connection, WebAnswer answer) {
    MHD_Response* response = make_response(answer);
    if (response == nullptr) return MHD_NO;
    add_fields(response, answer);
    const MHD_Result queued = MHD_queue_response(connection, static_cast<unsigned>(answer.status), response);
    MHD_destroy_response(response);
    return queued;
  }

  /// Changes the answer to 503 if clients leave too much unread.
  [[nodiscard]] MHD_Response* make_response(WebAnswer& answer) {
    if (answer.file) {
      const int descriptor = dup(answer.file->number());
      if (descriptor < 0) return nullptr;
      return MHD_create_response_from_fd_at_offset64(answer.of_file.length, descriptor, answer.of_file.offset);
    }
    const std::size_t size = answer.bytes.size();
    if (held_bytes_.fetch_add(size) + size > kMostBytes) {
      held_bytes_ -= size;
      answer = too_busy();
      return MHD_create_response_from_buffer(0, nullptr, MHD_RESPMEM_PERSISTENT);
    }
    auto held = std::make_unique<Held>(Held{.work = this, .bytes = std::move(answer.bytes)});
    MHD_Response* response = MHD_create_response_from_buffer_with_free_callback_cls(
        size, held->bytes.data(),
        [](void* one) {
          const std::unique_ptr<Held> sent(static_cast<Held*>(one));
          sent->work->held_bytes_ -= sent->bytes.size();
        },
        held.get());
    if (response == nullptr) {
      held_bytes_ -= size;
      return nullptr;
    }
    static_cast<void>(held.release());
    return response;
  }

  /// Suspends a connection until its answer is made. Returns false if too many wait already.
  [[nodiscard]] bool wait_for_maker(MHD_Connection* connection, Exchange& exchange) {
    const std::lock_guard lock(mutex_);
    if (is_ending_ || waiting_.size() >= kMostWaiting) return false;
    MHD_suspend_connection(connection);
    waiting_.emplace_back(connection, &exchange);
    came_.notify_one();
    return true;
  }

  static void finish(MHD_Connection* connection, Exchange& exchange, WebAnswer answer) {
    exchange.answer = std::move(answer);
    MHD_resume_connection(connection);
  }

  // thread: a maker
  void make_answers(const std::stop_token& stop) {
    for (;;) {
      std::unique_lock lock(mutex_);
      if (!came_.wait(lock, stop, [this] { return !waiting_.empty(); }) || stop.stop_requested()) return;
      const auto [connection, exchange] = waiting_.front();
      waiting_.pop_front();
      lock.unlock();
      WebAnswer made = too_busy();
      try {
        made = exchange->answer.later();
      } catch (const std::exception&) {
        made = {.status = MHD_HTTP_INTERNAL_SERVER_ERROR};
      }
      finish(connection, *exchange, std::move(made));
    }
  }

  Listener listener_;
  const Answerer answerer_;
  MHD_Daemon* daemon_ = nullptr;
  std::atomic<std::size_t> held_bytes_ = 0;
  std::mutex mutex_;
  std::condition_variable_any came_;
  std::deque<std::pair<MHD_Connection*, Exchange*>> waiting_;  ///< guarded by mutex_
  bool is_ending_ = false;                                     ///< guarded by mutex_
  std::vector<std::jthread> makers_;
};

HttpServer::HttpServer(std::unique_ptr<Work> work) : work_(std::move(work)) {}
HttpServer::~HttpServer() = default;

Result<std::unique_ptr<HttpServer>> HttpServer::start(const HttpServerOptions& options, Answerer answerer) {
  auto listener = listen_at(options);
  if (!listener) return listener.error();
  auto work = std::make_unique<Work>(*std::move(listener), std::move(answerer));
  if (Status started = work->start(options.connections); !started) return started.error();
  return std::unique_ptr<HttpServer>(new HttpServer(std::move(work)));
}

const std::string& HttpServer::address() const { return work_->listener().address; }
int HttpServer::port() const { return work_->listener().port; }
bool HttpServer::is_loopback() const { return work_->listener().is_loopback; }

}  // namespace terrella
