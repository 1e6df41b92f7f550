#pragma once

#include <cstdint>
#include <functional>

#include "geo/tile_grid.h"

namespace terrella {

/// Tiles of a level that exist(), that is on the planet and within the bounds. thread: any
[[nodiscard]] std::int64_t count_places(const TileGrid& grid, int level);

/// Calls for each of them, row by row from the north, until the call returns false. thread: any
void for_each_place(const TileGrid& grid, int level, const std::function<bool(const TileId&)>& call);

}  // namespace terrella
