#pragma once

#include <vector>

#include "base/result.h"
#include "streaming/numbers/number_statistics.h"
#include "tiles/tile_source.h"

namespace terrella {

/// The tiles that sample_tiles() reads: of the coarsest level with at least 2^17 pixels inside the bounds, else of the
/// finest one, and at most 64. thread: any
[[nodiscard]] std::vector<TileId> sampled_places(const TileGrid& grid);

/// Sums up a coarse level of a set of numbers (sampled_places()). Values have the set's scale and offset applied. Tiles
/// of a server are fetched, for at most 20 s together. Missing tiles have no data. Fails if a tile is broken, or if no
/// pixel has data; the error then says why a tile did not come. Blocks. thread: worker
[[nodiscard]] Result<NumberStatistics> sample_tiles(TileSource& tiles);

}  // namespace terrella
