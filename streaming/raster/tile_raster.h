#pragma once

#include <memory>

#include "streaming/raster/raster_source.h"

namespace terrella {

/// Describes a stored tile set as a raster: a level of the raster is a level of the set, a block is a full tile. The
/// coordinates of a set in a geodetic grid are longitudes and row latitudes, degrees, and the raster has no `crs`.
/// thread: any
[[nodiscard]] RasterInfo raster_info_of(const TileSetInfo& tiles);

/// Makes a raster of a set, local or remote. Blocks are passed on as they are stored; tiles outside the set are blank.
/// thread: any
[[nodiscard]] std::unique_ptr<RasterSource> raster_of_tiles(std::shared_ptr<TileSource> stored);

}  // namespace terrella
