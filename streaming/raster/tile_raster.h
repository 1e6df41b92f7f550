#pragma once

#include <memory>

#include "streaming/raster/raster_source.h"

namespace terrella {

/// Describes a stored tile set in a grid that is `projected` (TileSetInfo::square) or `web_mercator` as a raster: a
/// level of the raster is a level of the set, a block is a tile. thread: any
[[nodiscard]] RasterInfo raster_info_of(const TileSetInfo& tiles);

/// Makes a raster of such a set, local or remote. Blocks are passed on as they are stored; tiles outside the set are
/// blank. thread: any
[[nodiscard]] std::unique_ptr<RasterSource> raster_of_tiles(std::unique_ptr<TileSource> stored);

}  // namespace terrella
