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

struct HttpOptions {
  int connections_per_host = 6;                      ///< [1, 64]; HTTP/2 multiplexes over fewer
  int in_flight_per_host = 32;                       ///< requests that a host has not answered yet, [1, 1024]
  double rate_per_host = 0.0;                        ///< requests a second, token bucket, retries included; 0: no limit
  double burst = 32.0;                               ///< size of the bucket, requests
  int attempts = 5;                                  ///< of one request, the first included, [1, 20]
  std::chrono::milliseconds first_backoff{500};      ///< doubles with each attempt, ± 25 % jitter
  std::chrono::milliseconds longest_backoff{60000};  ///< of one wait; Retry-After may ask for more, up to longest_wait
  std::chrono::milliseconds longest_wait{600000};    ///< a host that asks for more is given up for now
  std::chrono::milliseconds connect_timeout{10000};
  std::chrono::milliseconds stall_timeout{20000};   ///< nothing, or less than 1 byte a second on average, for this long
  std::chrono::milliseconds total_timeout{120000};  ///< of one attempt
  std::size_t max_response_bytes = 32UL << 20;      ///< after decompression
  int max_redirects = 5;
  bool http2 = true;
  std::string ca_file;  ///< certificates to trust instead of the system's; empty: the system's
};

/// A request. Headers may hold secrets: they are sent to the host of `url` alone (not to where it redirects), and
/// stand in no message.
struct HttpRequest {
  std::uint64_t id = 0;              ///< the caller's; unique among what is under way
  Url url;                           ///< http, https or file
  std::vector<std::string> headers;  ///< "Name: value"
  std::string etag;                  ///< validators of what the caller has: asks conditionally
  std::string last_modified;
  double priority = 0.0;  ///< larger first
  /// Requests these bytes alone, at least one. The answer may end earlier if the file does. http and https only.
  std::optional<ByteRange> range = {};
  std::string if_match = {};  ///< strong entity tag of the file that the range belongs to; empty: any
};

enum class HttpOutcome {
  content,       ///< 200 with a whole body; 206 with the bytes of `range`
  not_modified,  ///< 304
  nothing,       ///< 204, 404 or 410: the server has no such thing
  refused,  ///< a server that ignores ranges, or a file that changed (412); 401, 403 and other 4xx that will not change
            ///< by asking again; redirect loops; bad certificates; a scheme that is not allowed; a body over the limit
  failed,  ///< could not be asked for now, after all attempts: time-outs, resets, 5xx, 429
};

struct HttpReply {
  std::uint64_t id = 0;
  HttpOutcome outcome = HttpOutcome::failed;
  int status = 0;  ///< 0: no answer
  std::vector<std::byte> body;
  std::string content_type;
  std::string etag;
  std::string last_modified;
  std::optional<std::int64_t> expires_unix_s;  ///< by Cache-Control max-age (less Age), else Expires; none if not said
  bool no_store = false;
  std::optional<std::uint64_t> file_bytes;  ///< length of the whole file, by Content-Range
  int attempts = 0;
  std::string why;  ///< for people: host and path without query, what was wrong; empty for content
};

/// A request counts as waiting or in flight until its reply has been given.
struct HttpCounts {
  std::size_t waiting = 0;    ///< submitted, not with the host
  std::size_t in_flight = 0;  ///< with the host
  std::size_t requests = 0;   ///< sent since the start, retries included
  std::size_t retries = 0;
  std::uint64_t body_bytes = 0;
};

class ReplyQueue;

/// One thread with libcurl's multi interface, for viewer and preloader alike: reuses connections, multiplexes HTTP/2,
/// takes the waiting request of the highest priority whenever a host may be asked (connections, token bucket, not told
/// to wait by 429 or 503 with Retry-After, which hold for the whole host). Every request that is not cancelled ends in
/// exactly one reply.
class HttpFetcher {
 public:
  /// Replies go to `replies`, which outlives the fetcher. The network thread calls nothing else of its user's, and does
  /// nothing that blocks.
  HttpFetcher(const HttpOptions& options, ReplyQueue& replies);
  ~HttpFetcher();  ///< gives up all that is under way, without replies
  HttpFetcher(const HttpFetcher&) = delete;
  HttpFetcher& operator=(const HttpFetcher&) = delete;

  void submit(HttpRequest request);                      ///< thread: any
  void set_priority(std::uint64_t id, double priority);  ///< no effect once sent or unknown. thread: any
  void cancel(std::uint64_t id);            ///< no reply follows, unless it is already on its way. thread: any
  [[nodiscard]] HttpCounts counts() const;  ///< thread: any

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace terrella
