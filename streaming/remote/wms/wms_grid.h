#pragma once

#include <optional>
#include <string>

#include "base/result.h"
#include "streaming/remote/remote_options.h"
#include "streaming/remote/wms/wms_layer.h"
#include "tiles/tile_source.h"

namespace terrella {

/// The grid in which a layer is asked for.
struct WmsGrid {
  std::string crs;  ///< value of CRS or SRS, as the document writes it
  bool northing_first = false;
  TileGrid grid;
  std::optional<CrsSquare> square;
  std::string body;
};

/// Limits that the server states.
struct WmsLimits {
  bool version_1_3 = true;
  int max_side_px = 0;  ///< 0: no limit
};

/// Chooses the layer's coordinate system and lays a grid over it. Longitude and latitude come first (EPSG:4326, CRS:84,
/// then codes of the IAU), then Web Mercator. Next comes the first other system that PROJ knows and that has a
/// BoundingBox. `wanted` names another system. The order of axes in version 1.3.0 is PROJ's. The error is the reason
/// alone. thread: any
[[nodiscard]] Result<WmsGrid> choose_wms_grid(const WmsLayer& layer, const WmsLimits& limits, const std::string& wanted,
                                              const RemoteOptions& options);

}  // namespace terrella
