#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "tiles/tile_grid.h"

namespace terrella {

/// Columns or rows [first, last]; none if last < first.
struct TileSpan {
  std::int64_t first = 0;
  std::int64_t last = -1;
};
/// The tiles of a level that exist(): every one of these columns in every one of these rows.
struct TilePlaces {
  std::vector<TileSpan> columns;  ///< ascending, apart; bounds over ±180° give more than one
  TileSpan rows;
};
[[nodiscard]] TilePlaces tile_places(const TileGrid& grid, int level);  ///< thread: any

/// Tiles of a level that exist(), that is on the planet and within the bounds. thread: any
[[nodiscard]] std::int64_t count_places(const TileGrid& grid, int level);

/// Calls for each of them, row by row from the north, until the call returns false. thread: any
void for_each_place(const TileGrid& grid, int level, const std::function<bool(const TileId&)>& call);

}  // namespace terrella
