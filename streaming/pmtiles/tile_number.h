#pragma once

#include <cstdint>

#include "tiles/tile_grid.h"

namespace terrella {

/// Number of a tile in a PMTiles archive: its place on the Hilbert curves of all levels, the coarsest level first. The
/// tile lies in its level's square of 2^level tiles. thread: any
[[nodiscard]] std::uint64_t tile_number(const TileId& id);
/// Number of the first tile of a level, [0, kMaxTileLevel + 1]. thread: any
[[nodiscard]] std::uint64_t first_number(int level);
/// The inverse of tile_number(), for numbers of levels up to kMaxTileLevel. thread: any
[[nodiscard]] TileId tile_of_number(std::uint64_t number);

}  // namespace terrella
