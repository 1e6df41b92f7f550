#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "streaming/url.h"

namespace terrella {

/// What of an address decides whom it belongs to.
struct WebAddress {
  std::string scheme;  ///< lower case
  std::string host;    ///< lower case, decoded, without a last dot; empty for file:
  std::string path;    ///< as written
  bool operator==(const WebAddress&) const = default;
};

/// Reads an address as libcurl does, which will ask for it; nothing if it is none. thread: any
[[nodiscard]] std::optional<WebAddress> parse_address(const Url& url);

/// True for text that begins like "scheme://". thread: any
[[nodiscard]] bool has_scheme(std::string_view text);

/// True if two texts are the same but for the case of ASCII letters. thread: any
[[nodiscard]] bool same_letters(std::string_view a, std::string_view b);
[[nodiscard]] std::string lower_case(std::string_view text);

/// Encodes all but letters, digits and "-._~:,". thread: any
[[nodiscard]] std::string percent_encode(std::string_view text);
/// Encodes braces alone, so that an address is no URL template. thread: any
[[nodiscard]] std::string encode_braces(std::string_view url);

}  // namespace terrella
