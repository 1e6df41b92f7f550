#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "base/result.h"
#include "streaming/byte_range.h"

namespace terrella::http {

/// Content-Range: the bytes in an answer's body, and the length of the whole file if the server says it.
struct ContentRange {
  ByteRange bytes;  ///< at least one
  std::optional<std::uint64_t> file_bytes;
};
/// Parses "bytes 0-99/1234" or "bytes 0-99/*" (RFC 9110, 14.4); none for anything else. thread: any
[[nodiscard]] std::optional<ContentRange> parse_content_range(std::string_view value);

/// Header fields of an answer that Terrella uses. The fields are untrusted: values that are too long or contain control
/// characters are dropped. thread: any, one at a time
struct ReplyFields {
  static constexpr std::size_t kMaxValueBytes = 1024;    ///< longest value that is kept
  static constexpr std::size_t kMaxBytes = 256 << 10;    ///< most bytes of all lines together (see `bytes`)
  static constexpr std::int64_t kForever_s = 1LL << 31;  ///< longer times mean this (RFC 9111, 1.2.2)

  std::string content_type;
  std::string etag;
  std::string last_modified;
  std::optional<std::int64_t> max_age_s;  ///< [0, kForever_s]; 0 if unreadable
  std::optional<std::int64_t> age_s;      ///< [0, kForever_s]
  /// 0 for an unreadable date, which means "already expired" (RFC 9111, 5.3)
  std::optional<std::int64_t> expires_unix_s;
  std::optional<std::int64_t> date_unix_s;      ///< the server's clock
  std::optional<std::int64_t> retry_after_s;    ///< given as seconds, [0, kForever_s]
  std::optional<std::int64_t> retry_at_unix_s;  ///< given as a date
  std::optional<ContentRange> content_range;
  bool no_store = false;
  bool no_cache = false;
  std::size_t bytes = 0;  ///< bytes of all lines, interim answers included

  void clear();  ///< keeps the capacity of the texts
};

/// Reads one line, with or without its line end. A status line resets the fields, so that fields of an interim answer
/// (1xx) do not count.
void read_field_line(std::string_view line, ReplyFields& fields);

/// Time until which the answer may be used without asking: `now_unix_s` plus max-age less Age, else plus Expires less
/// Date. In the past or now if the answer must not be used without asking; none if the headers give no time. RFC 9111,
/// 4.2.1.
[[nodiscard]] std::optional<std::int64_t> expiry_unix_s(const ReplyFields& fields, std::int64_t now_unix_s);

/// Pause that the server asks for, > 0. A date is compared with the server's own clock if known. RFC 9110, 10.2.3.
[[nodiscard]] std::optional<std::chrono::seconds> retry_after(const ReplyFields& fields, std::int64_t now_unix_s);

/// Checks that a caller's "Name: value" may be sent: a token, a colon, no control characters, and no field that the
/// fetcher sets itself. The error names the field, never the value.
[[nodiscard]] Status check_request_header(std::string_view header);

/// True if the text has no control character except tab. Others could end the line and inject another.
[[nodiscard]] bool is_field_value(std::string_view text);

}  // namespace terrella::http
