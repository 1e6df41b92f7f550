#pragma once

#include <cstdint>
#include <string>

#include "base/result.h"
#include "streaming/url.h"

namespace terrella::http {

/// Destination of a request. thread: any
struct Address {
  enum class Scheme { http, https, file };
  Scheme scheme = Scheme::http;
  std::string origin;  ///< "https://tiles.example:443": scheme, host in lower case, port; "file://" for a file
  std::string path;    ///< http and https: as in the address; file: decoded and absolute. Excludes the query
};

/// Parses an address. Refuses other schemes, spaces and control characters. The error names host and path if they are
/// known, and never the query, which may hold a key.
[[nodiscard]] Result<Address> parse_http_address(const Url& url);

/// Address without query, user and password, for people.
[[nodiscard]] std::string shown(const Address& address);

}  // namespace terrella::http
