#pragma once

#include <optional>
#include <pugixml.hpp>
#include <string>
#include <vector>

#include "geo/coordinates.h"
#include "streaming/remote/wmts/wmts_time.h"

namespace terrella {

/// A <BoundingBox>: corners in the order of the system's axes, as written.
struct WmsBox {
  std::string crs{};
  double low_first = 0.0, low_second = 0.0, high_first = 0.0, high_second = 0.0;
};

/// A named <Layer> with everything that it inherits from the layers around it (OGC 06-042, 7.2.4.8).
struct WmsLayer {
  std::string name{};
  std::string title{};
  std::string attribution{};
  std::vector<std::string> crs{};     ///< in the order of the document, the layer's own before those inherited
  std::vector<std::string> styles{};  ///< default first
  std::vector<WmsBox> boxes{};        ///< own before inherited
  std::optional<GeoRect> bounds{};
  std::optional<double> min_scale{};  ///< scale denominators between which the server draws the layer
  std::optional<double> max_scale{};
  bool opaque = false;
  std::vector<WmtsDimension> dimensions{};
};

/// Reads all named layers of a <Capability>, of version 1.1.1 or 1.3.0, outer layers first. thread: any
[[nodiscard]] std::vector<WmsLayer> read_wms_layers(const pugi::xml_node& capability);

}  // namespace terrella
