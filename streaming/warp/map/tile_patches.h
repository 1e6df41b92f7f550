#pragma once

#include <optional>
#include <vector>

#include "streaming/warp/map/patch.h"
#include "streaming/warp/map/pixel_map.h"

namespace terrella {

/// The area of a raster's level, in its pixels.
struct RasterArea {
  double width_px = 0.0;
  double height_px = 0.0;
  std::optional<CrsPoint> turn_px = {};  ///< as GroundMap::turn_px()
  /// Columns go on from the last to the first: the raster goes once round the planet, and a turn is a whole number of
  /// its columns.
  [[nodiscard]] bool is_cyclic() const;
};

/// Divides a tile into patches. Patches of the same size as a pixel are exact at its centre; the others are within 0.05
/// source pixels of PROJ's own answer, or of the pixels of an overview that suits the tile. Places without a source
/// pixel are in no patch: their map has no point, or the point is not on the raster. thread: one at a time for a map
[[nodiscard]] std::vector<Patch> tile_patches(const PixelMap& tile, const RasterArea& raster);

}  // namespace terrella
