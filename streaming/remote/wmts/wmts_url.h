#pragma once

#include <map>
#include <string>

#include "base/result.h"
#include "streaming/remote/wmts/wmts_layer.h"

namespace terrella {

/// Parameters common to all tile requests of a layer.
struct WmtsRequest {
  std::string layer{};
  std::string style{};
  std::string matrix_set{};
  std::string media_type{};
  std::map<std::string, std::string> dimensions{};  ///< by the name in the document
};

/// Converts a <ResourceURL>'s template to a RemoteTileSet's URL template. The error is the reason alone. thread: any
[[nodiscard]] Result<std::string> rest_template(const std::string& wmts_template, const WmtsRequest& request);

/// Makes a URL template for GetTile with key-value pairs. thread: any
[[nodiscard]] std::string kvp_template(const std::string& address, const WmtsRequest& request);

}  // namespace terrella
