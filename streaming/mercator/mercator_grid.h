#pragma once

#include <vector>

#include "streaming/mercator/mercator_taps.h"
#include "tiles/tile_grid.h"

namespace terrella {

/// Equirectangular grid for drawing a set in Web Mercator. The root tile has the same span in longitude and the same
/// pixels, so texel columns are equal and only rows need resampling. Level numbers begin equally.
/// The grid has finer levels than the set, until a texel along the meridian is as short as Mercator's at the end of the
/// bounds (3 more levels for 85°). The rows of a level are equal in latitude, while Mercator's get finer towards the
/// poles. `mercator` must pass check_grid(). thread: any
[[nodiscard]] TileGrid geodetic_grid_of(const TileGrid& mercator);

/// A stored tile that contributes to a geodetic tile.
struct MercatorPiece {
  TileId id;
  std::int64_t first_column = 0;  ///< north-west corner in the source texels of the plan
  std::int64_t first_row = 0;
  bool core = false;  ///< lies under the tile itself; false: only under the filter's reach beyond its sides
};

/// Recipe for a tile of geodetic_grid_of(mercator): source tiles, texels and weights.
struct MercatorPlan {
  int level = 0;  ///< level of the stored tiles
  int tile_px = 0;
  std::int64_t columns = 0, rows = 0;  ///< size in source texels; taps count from the north-west corner
  std::vector<MercatorPiece> pieces;   ///< only tiles that exist(); at most 14 for a set that begins at level 0
  std::vector<Taps> column_taps;       ///< for each column of the tile
  std::vector<RowTaps> row_taps;       ///< for each row of the tile
};

/// Plans a geodetic tile.
/// The stored level is the coarsest whose texels along the meridian are no longer than the tile's at the tile's edge
/// nearest to the equator, within the existing levels. Mercator's texels shrink with cos(latitude) in both directions.
/// At 60° one level coarser therefore has all visible detail, and needs a quarter of the tiles. thread: any
[[nodiscard]] MercatorPlan plan_tile(const TileGrid& mercator, const TileId& geodetic);

}  // namespace terrella
