#pragma once

#include <string>
#include <vector>

#include "tiles/tile_source.h"

namespace terrella {

/// Gives a set levels with places of their own: its square, which begins at the finest level's corner, and a
/// `projected` grid that has at least their numbers of tiles. Keeps the tile size. thread: any
void place_own_levels(const std::string& crs, std::vector<CrsLevel> levels, TileSetInfo& info);

/// Number of tiles of this span that cover a length, a whole number from 1 to infinity. A millionth of a tile is
/// rounding. thread: any
[[nodiscard]] double tiles_over(double length, double span);

/// Number of tiles of a level along its longer side. thread: any
[[nodiscard]] std::int64_t longer_side(const CrsLevel& level);

/// `tiles` divided by 2^times, rounded up. thread: any
[[nodiscard]] std::int64_t halved_up(std::int64_t tiles, std::size_t times);

}  // namespace terrella
