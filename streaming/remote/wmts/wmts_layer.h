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
  std::vector<std::string> styles{};  ///< the default first
  std::vector<std::string> formats{};
  std::vector<WmtsLink> links{};
  std::vector<WmtsDimension> dimensions{};
  std::vector<WmtsResource> resources{};  ///< of tiles
  std::optional<GeoRect> bounds{};        ///< WGS84BoundingBox; none if it is not there or makes no sense
};

[[nodiscard]] WmtsLayer read_wmts_layer(const pugi::xml_node& node);

/// Where GetTile with key-value pairs is answered; empty: nowhere.
[[nodiscard]] std::string kvp_address(const pugi::xml_node& capabilities);

}  // namespace terrella
