#pragma once

#include <cstddef>
#include <vector>

#include "tiles/tile_grid.h"

// thread: any, for all of this header
namespace terrella {

/// The heights of one tile, metres over the ellipsoid (or over what the data's makers count from), rows from the north.
/// A height is that of its pixel's middle. Where none is known stands what lies around it, falling to 0.
struct HeightTile {
  TileId id;
  int side_px = 0;
  std::vector<float> heights_m;  ///< side_px · side_px, all finite
  float min_m = 0.0F;            ///< of all heights_m
  float max_m = 0.0F;
  std::size_t unknown = 0;  ///< of how many none is known
};

[[nodiscard]] inline std::size_t size_bytes(const HeightTile& tile) { return tile.heights_m.size() * sizeof(float); }

}  // namespace terrella
