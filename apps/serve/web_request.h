#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "streaming/byte_range.h"
#include "streaming/descriptor.h"

// thread: any, for all of this header
namespace terrella {

/// A request of HTTP, with fields as sent. Nothing is decoded.
struct WebRequest {
  std::string_view method = "GET";
  std::string_view target{};  ///< path and query
  std::string_view base{};    ///< "http://127.0.0.1:8080", which the addresses in descriptions begin with
  std::string_view if_none_match{}, range{}, if_range{};  ///< header fields; empty: not sent
};

/// An answer of HTTP. The answer to HEAD is that to GET, and whoever sends it leaves out the content.
struct WebAnswer {
  int status = 200;
  std::string type{};              ///< media type; empty: no content
  std::vector<std::byte> bytes{};  ///< content, unless `file` is set
  std::shared_ptr<const Descriptor> file{};
  ByteRange of_file{};
  std::string etag{};           ///< with its quotes; empty: none
  std::string content_range{};  ///< empty: none
  /// Set if the answer takes milliseconds or more. It then makes the answer, and the other fields mean nothing.
  std::function<WebAnswer()> later{};
};

/// True for letters, digits and "._-", which need no encoding in an address.
[[nodiscard]] bool is_plain_in_addresses(char c);

/// Keys in lower case and decoded values of a query. The first of two equal keys counts, and keys after the 64th do
/// not.
[[nodiscard]] std::map<std::string, std::string> read_query(std::string_view query);

/// Reads a whole number without a sign or leading zeros; -1 for other texts.
[[nodiscard]] std::int64_t read_count(std::string_view text);

/// The part of a file that a Range header asks for (RFC 9110, 14.2).
struct AskedRange {
  enum class Kind { whole, part, beyond } kind = Kind::whole;
  ByteRange range{};
};
/// Reads a header with one range. Wrong headers and several ranges ask for the whole file, as the standard allows.
[[nodiscard]] AskedRange asked_range(std::string_view header, std::uint64_t file_bytes);

/// True if an If-None-Match header names the ETag, or any.
[[nodiscard]] bool names_etag(std::string_view header, std::string_view etag);

}  // namespace terrella
