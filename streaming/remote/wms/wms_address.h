#pragma once

#include <string>
#include <string_view>

#include "streaming/remote/remote_options.h"
#include "streaming/url.h"

namespace terrella {

/// Address of a WMS as the user gave it: of its capabilities, or of a picture (GetMap).
struct WmsAddress {
  Url capabilities{};    ///< asks for the capabilities, in the version given, else 1.3.0
  std::string layers{};  ///< values of the address; empty: not said
  std::string styles{};
  std::string crs{};
  std::string format{};
  std::string time{};
  std::string extra{};  ///< the other parameters, "map=a&key=b", which may be secret
};

/// True for an address with "service=WMS" or "request=GetMap" in its query. Ignores case. thread: any
[[nodiscard]] bool is_wms_address(std::string_view address);

/// Splits an address into parameters. thread: any
[[nodiscard]] WmsAddress read_wms_address(const Url& address);

/// Address of a server with the query parameters that WMS does not define, those of `extra` added unless it has them.
/// Ends in "?" or "&". thread: any
[[nodiscard]] std::string wms_base(std::string_view server, std::string_view extra);

}  // namespace terrella
