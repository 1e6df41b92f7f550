#pragma once

#include "base/result.h"
#include "streaming/cache/tile_cache.h"
#include "streaming/preload/tile_plan.h"

namespace terrella {

/// True if a cache has every planned tile of the western half of the planet, and records every one of the eastern half
/// as missing. So it is after a preload of a server with one column at level 0, as Web Mercator has, by a grid with
/// two. False for plans of level 0 alone, which prove nothing. Looks no further than to the first tile that
/// contradicts. thread: any
[[nodiscard]] Result<bool> looks_like_one_column(const TilePlan& plan, const TileGrid& grid, TileCache& cache);

}  // namespace terrella
