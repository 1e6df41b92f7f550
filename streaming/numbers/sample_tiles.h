#pragma once

#include "base/result.h"
#include "streaming/numbers/number_statistics.h"
#include "tiles/tile_source.h"

namespace terrella {

/// Sums up a coarse level of a set of numbers: the coarsest one with at least 2^17 pixels inside the bounds, else the
/// finest one, and of that at most 64 tiles. Values have the set's scale and offset applied. Tiles of a server are
/// fetched, for at most 20 s together. Missing tiles have no data. Fails if a tile is broken, or if no pixel has data.
/// Blocks. thread: worker
[[nodiscard]] Result<NumberStatistics> sample_tiles(TileSource& tiles);

}  // namespace terrella
