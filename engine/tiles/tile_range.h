#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "base/result.h"
#include "tiles/tile_grid.h"

namespace terrella {

/// Columns or rows [first, last]; empty if last < first.
struct TileSpan {
  std::int64_t first = 0;
  std::int64_t last = -1;
};
/// The tiles of a level that exist(): each of these columns in each of these rows.
struct TilePlaces {
  std::vector<TileSpan> columns;  ///< ascending and separate; several if the bounds cross ±180°
  TileSpan rows;
};
[[nodiscard]] TilePlaces tile_places(const TileGrid& grid, int level);  ///< thread: any

/// Number of tiles of a level that exist(), that is, on the planet and within the bounds. thread: any
[[nodiscard]] std::int64_t count_places(const TileGrid& grid, int level);

/// Calls `call` for each tile that exists(), row by row from the north, until `call` returns false. thread: any
void for_each_place(const TileGrid& grid, int level, const std::function<bool(const TileId&)>& call);

/// The tiles of the coarsest level, reduced_tile() for each: always wanted, never evicted (engine/DESIGN.md, 10).
/// thread: any
[[nodiscard]] std::vector<TileId> root_tiles(const TileGrid& grid);
/// Most root tiles of a grid that is drawn: they stay in memory.
inline constexpr std::int64_t kMostRootTiles = 16'384;
/// Error if the grid has more root tiles. thread: any
[[nodiscard]] Status check_root_tiles(const TileGrid& grid);

}  // namespace terrella
