#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "streaming/byte_range.h"
#include "streaming/url.h"

namespace terrella {

struct HttpOptions {             // a value beyond its range counts as the nearest end
  int connections_per_host = 6;  ///< [1, 64]; HTTP/2 multiplexes over fewer
  int in_flight_per_host = 32;   ///< sent requests without a reply, [1, 1024]
  double rate_per_host = 0.0;    ///< requests a second including retries, by token bucket; 0: no limit
  double burst = 32.0;           ///< size of the token bucket, requests, at least 1
  int attempts = 5;              ///< attempts of one request, including the first, [1, 20]
  std::chrono::milliseconds first_backoff{
      500};  ///< wait before the first retry; doubles with each retry, ± 25 % jitter
  std::chrono::milliseconds longest_backoff{60000};  ///< longest such wait; Retry-After may ask for up to longest_wait
  std::chrono::milliseconds longest_wait{600000};    ///< requests to a host that asks for a longer wait fail for now
  std::chrono::milliseconds connect_timeout{10000};
  std::chrono::milliseconds stall_timeout{20000};   ///< an attempt fails after this time below 1 byte a second
  std::chrono::milliseconds total_timeout{120000};  ///< time limit of one attempt
  std::size_t max_response_bytes = 32UL << 20;      ///< largest body after decompression
  int max_redirects = 5;
  bool http2 = true;
  std::string ca_file;  ///< certificates to trust instead of the system's; empty: the system's
};

/// A request. Headers may hold secrets. They are sent only to the host of `url`, not to hosts of redirects, and appear
/// in no message.
struct HttpRequest {
  std::uint64_t id = 0;              ///< chosen by the caller; unique among requests without a reply
  Url url;                           ///< http, https or file
  std::vector<std::string> headers;  ///< "Name: value"
  std::string etag;                  ///< validators of the caller's copy, for a conditional request
  std::string last_modified;
  double priority = 0.0;  ///< larger first
  /// Requests these bytes alone, at least one. The answer may end earlier if the file does. http and https only.
  std::optional<ByteRange> range = {};
  std::string if_match = {};  ///< strong entity tag of the file that the range belongs to; empty: any
};

enum class HttpOutcome {
  content,       ///< 200 with a whole body; 206 with the bytes of `range`
  not_modified,  ///< 304
  nothing,       ///< 204, 404 or 410: the server does not have it
  refused,       ///< a retry cannot help: 401, 403 and other 4xx, redirect loops, bad certificates, forbidden schemes,
                 ///< bodies over the limit, ranges that the server ignores, a file that changed (412)
  failed,        ///< all attempts failed for now: time-outs, resets, 5xx, 429
  broken,        ///< never from HttpFetcher: who checks the body says that it does not decode, even when asked again
};

struct HttpReply {
  std::uint64_t id = 0;
  HttpOutcome outcome = HttpOutcome::failed;
  int status = 0;  ///< HTTP status; 0: no answer
  std::vector<std::byte> body;
  std::string content_type;
  std::string etag;
  std::string last_modified;
  std::optional<std::int64_t> expires_unix_s;  ///< Cache-Control max-age less Age, else Expires; or none
  bool no_store = false;
  std::optional<std::uint64_t> file_bytes;  ///< length of the whole file, by Content-Range
  int attempts = 0;
  std::string why;  ///< message: host and path without query, and what is wrong; empty for content
};

/// Statistics. A request counts as waiting or in flight until its reply is in the queue.
struct HttpCounts {
  std::size_t waiting = 0;    ///< submitted, not sent
  std::size_t in_flight = 0;  ///< sent, no reply yet
  std::size_t requests = 0;   ///< sent since the start, retries included
  std::size_t retries = 0;
  std::uint64_t body_bytes = 0;
};

class ReplyQueue;

/// Sends HTTP requests from one network thread with libcurl's multi interface. It reuses connections and multiplexes
/// HTTP/2. When a host has room, the thread sends the waiting request with the highest priority. Connections, the token
/// bucket and Retry-After limit a host; Retry-After of a 429 or 503 holds for the whole host. Every request that is not
/// cancelled ends in exactly one reply.
class HttpFetcher {
 public:
  /// Replies go to `replies`, which must outlive the fetcher. The network thread calls no other code of the user and
  /// does nothing that blocks.
  HttpFetcher(const HttpOptions& options, ReplyQueue& replies);
  ~HttpFetcher();  ///< drops all requests without replies
  HttpFetcher(const HttpFetcher&) = delete;
  HttpFetcher& operator=(const HttpFetcher&) = delete;

  void submit(HttpRequest request);                      ///< thread: any
  void set_priority(std::uint64_t id, double priority);  ///< no effect on sent or unknown requests. thread: any
  void cancel(std::uint64_t id);            ///< no reply follows, unless it is in the queue already. thread: any
  [[nodiscard]] HttpCounts counts() const;  ///< thread: any

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace terrella
