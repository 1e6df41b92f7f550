#pragma once

#include <curl/curl.h>

#include <chrono>
#include <string_view>

#include "streaming/http/http_fetcher.h"

namespace terrella::http {

/// Why a transfer was ended from our side.
enum class Cut {
  none,
  body_too_large,    ///< over max_response_bytes after decompression
  headers_too_long,  ///< over ReplyFields::kMaxBytes
  error_body,        ///< the rest of a page that explains an error; the status is known
  no_memory,
};

/// How one attempt ended.
struct Answer {
  CURLcode code = CURLE_OK;
  int status = 0;            ///< 0: none
  bool conditional = false;  ///< validators were sent
  Cut cut = Cut::none;
};

/// What follows from it.
struct Verdict {
  enum class Next {
    reply,     ///< over
    again,     ///< worth another attempt; if there is none left, over with `outcome`
    wait,      ///< the same, and the whole host is to be left alone for a while
    redirect,  ///< ask where the answer points
  };
  Next next = Next::reply;
  HttpOutcome outcome = HttpOutcome::failed;
  std::string_view why;  ///< for people; empty for content
};
[[nodiscard]] Verdict judge(const Answer& answer);

/// How long to wait after the attempt of this number (1 is the first): doubles each time up to the longest, ± 25 % by
/// `random` in [0, 1).
[[nodiscard]] std::chrono::milliseconds backoff(const HttpOptions& options, int attempt, double random);

}  // namespace terrella::http
