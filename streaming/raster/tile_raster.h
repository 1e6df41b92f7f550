#pragma once

#include <memory>

#include "streaming/raster/raster_source.h"

namespace terrella {

/// Makes a raster of a stored tile set in a `projected` grid (TileSetInfo::square), local or remote: a level of the
/// raster is a level of the set, a block is a tile. Blocks are passed on as they are stored. thread: any
[[nodiscard]] std::unique_ptr<RasterSource> raster_of_tiles(std::unique_ptr<TileSource> stored);

}  // namespace terrella
