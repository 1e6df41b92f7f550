#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "streaming/url.h"

namespace terrella {

/// Parts of an address that decide who owns it.
struct WebAddress {
  std::string scheme;  ///< lower case
  std::string host;    ///< lower case, decoded, without a final dot; empty for file:
  std::string path;    ///< as written
  bool operator==(const WebAddress&) const = default;
};

/// Parses an address as libcurl does, because libcurl will request it. Returns nothing if the text is no address.
/// thread: any
[[nodiscard]] std::optional<WebAddress> parse_address(const Url& url);

/// True for text that begins like "scheme://". thread: any
[[nodiscard]] bool has_scheme(std::string_view text);

/// True for an address of http:// or https://. thread: any
[[nodiscard]] bool is_from_network(const Url& address);

/// Compares two texts, ignoring the case of ASCII letters. thread: any
[[nodiscard]] bool same_letters(std::string_view a, std::string_view b);
[[nodiscard]] std::string lower_case(std::string_view text);

/// Encodes all but letters, digits and "-._~:,". thread: any
[[nodiscard]] std::string percent_encode(std::string_view text);
/// Decodes "%20" and the like. Returns the text unchanged if it cannot be decoded. thread: any
[[nodiscard]] std::string percent_decode(std::string_view text);
/// Encodes only braces, so that an address is not taken for a URL template. thread: any
[[nodiscard]] std::string encode_braces(std::string_view url);

}  // namespace terrella
