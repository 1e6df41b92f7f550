#pragma once

#include <optional>
#include <pugixml.hpp>
#include <string>
#include <vector>

#include "geo/coordinates.h"
#include "streaming/remote/wmts/wmts_matrix_set.h"
#include "streaming/remote/wmts/wmts_time.h"

namespace terrella {

struct WmtsResource {
  std::string format{};        ///< media type
  std::string url_template{};  ///< with WMTS's placeholders
};

struct WmtsLink {
  std::string matrix_set{};
  std::vector<WmtsLimits> limits{};
};

/// A <Layer> of the contents, as written.
struct WmtsLayer {
  std::string name{};
  std::string title{};
  std::vector<std::string> styles{};  ///< default first
  std::vector<std::string> formats{};
  std::vector<WmtsLink> links{};
  std::vector<WmtsDimension> dimensions{};
  std::vector<WmtsResource> resources{};  ///< addresses of tiles
  std::optional<GeoRect> bounds{};        ///< WGS84BoundingBox; none if missing or invalid
};

[[nodiscard]] WmtsLayer read_wmts_layer(const pugi::xml_node& node);

/// Address for GetTile with key-value pairs; empty if there is none.
[[nodiscard]] std::string kvp_address(const pugi::xml_node& capabilities);

}  // namespace terrella
