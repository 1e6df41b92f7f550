#pragma once

#include <curl/curl.h>

#include <chrono>
#include <string_view>

#include "streaming/http/http_fetcher.h"

namespace terrella::http {

/// Reason why Terrella ended a transfer.
enum class Cut {
  none,
  body_too_large,    ///< over max_response_bytes after decompression
  headers_too_long,  ///< over ReplyFields::kMaxBytes
  error_body,        ///< skipped the rest of an error page; the status is known
  no_memory,
};

/// Result of one attempt.
struct Answer {
  CURLcode code = CURLE_OK;
  int status = 0;            ///< 0: none
  bool conditional = false;  ///< validators were sent
  bool ranged = false;       ///< a range was requested
  bool range_fits = false;   ///< the answer's Content-Range and body are that range, or its part up to the file's end
  Cut cut = Cut::none;
};

/// Decision about an attempt.
struct Verdict {
  enum class Next {
    reply,     ///< finished
    again,     ///< retry; without attempts left, finished with `outcome`
    wait,      ///< like `again`, and pause the whole host
    redirect,  ///< follow the redirect
  };
  Next next = Next::reply;
  HttpOutcome outcome = HttpOutcome::failed;
  std::string_view why;  ///< for people; empty for content
};
[[nodiscard]] Verdict judge(const Answer& answer);

/// Wait after attempt number `attempt` (starting at 1). Doubles each time up to the longest wait, ± 25 % by `random` in
/// [0, 1).
[[nodiscard]] std::chrono::milliseconds backoff(const HttpOptions& options, int attempt, double random);

}  // namespace terrella::http
