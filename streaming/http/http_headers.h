#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "base/result.h"

namespace terrella::http {

/// What of an answer's header fields matters here. Untrusted: values that are too long or hold control characters are
/// left out. thread: any, one at a time
struct ReplyFields {
  static constexpr std::size_t kMaxValueBytes = 1024;    ///< of a value that is kept
  static constexpr std::size_t kMaxBytes = 256 << 10;    ///< of all lines together (see `bytes`)
  static constexpr std::int64_t kForever_s = 1LL << 31;  ///< longer times mean this much (RFC 9111, 1.2.2)

  std::string content_type;
  std::string etag;
  std::string last_modified;
  std::optional<std::int64_t> max_age_s;        ///< [0, kForever_s]; unreadable: 0
  std::optional<std::int64_t> age_s;            ///< [0, kForever_s]
  std::optional<std::int64_t> expires_unix_s;   ///< 0 for an unreadable date, which means "already" (RFC 9111, 5.3)
  std::optional<std::int64_t> date_unix_s;      ///< the server's clock
  std::optional<std::int64_t> retry_after_s;    ///< as a number of seconds, [0, kForever_s]
  std::optional<std::int64_t> retry_at_unix_s;  ///< as a date
  bool no_store = false;
  bool no_cache = false;
  std::size_t bytes = 0;  ///< of all lines, interim answers included

  void clear();  ///< keeps the capacity of the texts
};

/// Takes in one line, with or without its line end. A status line begins anew, so that the fields of an interim answer
/// (1xx) do not count.
void read_field_line(std::string_view line, ReplyFields& fields);

/// Until when the answer may be used without asking: max-age less Age, else Expires less Date, from `now_unix_s` on; in
/// the past or now if it must not be used without asking; none if nothing is said. RFC 9111, 4.2.1.
[[nodiscard]] std::optional<std::int64_t> expiry_unix_s(const ReplyFields& fields, std::int64_t now_unix_s);

/// How long the server asks to be left alone, > 0; a date counts from the server's own clock where it is told. RFC
/// 9110, 10.2.3.
[[nodiscard]] std::optional<std::chrono::seconds> retry_after(const ReplyFields& fields, std::int64_t now_unix_s);

/// Whether a caller's "Name: value" may be sent: a token, a colon, no control characters, and not a field that the
/// fetcher sets itself. The error names the field, never the value.
[[nodiscard]] Status check_request_header(std::string_view header);

/// Whether the text holds no control character but tab: what else would end a line and begin another.
[[nodiscard]] bool is_field_value(std::string_view text);

}  // namespace terrella::http
