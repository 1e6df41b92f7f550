#pragma once

#include <vector>

#include "streaming/mercator/mercator_taps.h"
#include "tiles/tile_grid.h"

namespace terrella {

/// The equirectangular grid in which a set in Web Mercator is drawn. Its root tile spans the same longitudes and has
/// as many pixels, so that columns of texels are the same and only rows need resampling, from level to level; levels
/// begin with the same number. They go on beyond the finest until a texel along the meridian is as short as Mercator's
/// are at the bounds' end (3 levels if that is 85°): a level's rows are equal in latitude, Mercator's get finer towards
/// the poles. `mercator` must pass check_grid(). thread: any
[[nodiscard]] TileGrid geodetic_grid_of(const TileGrid& mercator);

/// A stored tile that a geodetic one is made of.
struct MercatorPiece {
  TileId id;
  std::int64_t first_column = 0;  ///< where it lies in the source texels of the plan, west and north side
  std::int64_t first_row = 0;
  bool core = false;  ///< lies under the tile itself; else only under the filter's reach beyond its sides
};

/// How a tile of geodetic_grid_of(mercator) is made: which texels, of which tiles, with which weights.
struct MercatorPlan {
  int level = 0;  ///< of the stored tiles
  int tile_px = 0;
  std::int64_t columns = 0, rows = 0;  ///< of source texels; the taps count from their north-west corner
  std::vector<MercatorPiece> pieces;   ///< those that exist(); 14 at most of a set that begins at level 0
  std::vector<Taps> column_taps;       ///< for each column of the tile
  std::vector<RowTaps> row_taps;       ///< for each row of the tile
};

/// The stored level is the coarsest whose texels along the meridian are no longer than the tile's, at the tile's edge
/// nearest to the equator, within the levels that there are: Mercator's texels shrink with cos(latitude) both ways, so
/// at 60° a level less has all that can be seen, and asks for a quarter of the tiles. thread: any
[[nodiscard]] MercatorPlan plan_tile(const TileGrid& mercator, const TileId& geodetic);

}  // namespace terrella
