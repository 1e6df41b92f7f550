#pragma once

#include <cstdint>
#include <string>

#include "base/result.h"
#include "streaming/url.h"

namespace terrella::http {

/// Where a request goes. thread: any
struct Address {
  enum class Scheme { http, https, file };
  Scheme scheme = Scheme::http;
  std::string origin;  ///< "https://tiles.example:443": scheme, host in lower case, port; "file://" for a file
  std::string path;    ///< as in the address for http and https; decoded, absolute, for a file. No query
};

/// Refuses other schemes and addresses with blanks or control characters. The error names host and path where they can
/// be told, and never the query, which may hold a key.
[[nodiscard]] Result<Address> parse_http_address(const Url& url);

/// Address without query, user and password, for people.
[[nodiscard]] std::string shown(const Address& address);

}  // namespace terrella::http
