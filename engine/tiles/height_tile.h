#pragma once

#include <cstddef>
#include <vector>

#include "tiles/tile_grid.h"

// thread: any, for all of this header
namespace terrella {

/// The heights of one tile, metres over the ellipsoid (or over the zero level of the data), rows from the north. Each
/// height is that of its pixel's centre. Unknown heights are filled from their surroundings, falling to 0. thread: any
struct HeightTile {
  TileId id;
  int side_px = 0;
  std::vector<float> heights_m;  ///< side_px · side_px, all finite
  float min_m = 0.0F;            ///< lowest of heights_m
  float max_m = 0.0F;
  std::size_t unknown = 0;  ///< number of filled heights
};

[[nodiscard]] inline std::size_t size_bytes(const HeightTile& tile) { return tile.heights_m.size() * sizeof(float); }

}  // namespace terrella
