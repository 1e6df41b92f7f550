#pragma once

#include <functional>
#include <span>

#include "streaming/warp/map/ground_map.h"
#include "streaming/warp/map/patch.h"
#include "tiles/tile_grid.h"

namespace terrella {

/// Source pixels per pixel of a tile, with lengths on the ground that are equal in all directions.
struct GroundScale {
  Jacobian pixels;
  double area = 1.0;  ///< area of the tile's pixel on the ground, relative to other pixels of the tile
};

/// The pixels of a raster's finest level that lie under the pixels of a tile. Refers to the map that made it.
/// thread: one at a time for a map
struct PixelMap {
  int tile_px = 0;
  int rows = 0;            ///< rows that lie on the planet; a row of which the pole cuts off a part counts
  double pixel_deg = 0.0;  ///< size of the tile's pixels on the ground, degrees; a rough figure
  /// Finds the pixel under each place of the tile; infinite if there is none. In a raster with a turn the pixels
  /// continue beyond its ends.
  std::function<void(std::span<const CrsPoint> places_px, std::span<CrsPoint> out)> pixels;
  /// Scales the derivatives at a place of the tile.
  std::function<GroundScale(const Jacobian& pixels, double x, double y)> on_ground;
};

/// A tile of a geodetic grid. thread: one at a time for a map
[[nodiscard]] PixelMap map_of_tile(const GroundMap& map, const TileGrid& grid, const TileId& id);

}  // namespace terrella
