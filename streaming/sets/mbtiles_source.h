#pragma once

#include <filesystem>
#include <memory>

#include "tiles/tile_source.h"

namespace terrella {

/// Opens an MBTiles file, whose rows count from the south. The specification means Web Mercator, whose tiles are given
/// as they are stored; a geodetic one says so in its metadata (`profile` geodetic, or `crs` or `srs` EPSG:4326 or
/// CRS84), or `geodetic` does. Whether that has one root tile or two its tiles tell, with the bounds of its metadata.
[[nodiscard]] Result<std::unique_ptr<TileSource>> open_mbtiles(const std::filesystem::path& path, bool geodetic);

}  // namespace terrella
