#pragma once

#include <filesystem>
#include <memory>

#include "tiles/tile_source.h"

namespace terrella {

/// Opens an MBTiles file; its rows count from the south.
/// The specification means Web Mercator; tiles of such a file are returned as stored. A geodetic file is recognised by
/// its metadata (`profile` geodetic, or `crs` or `srs` EPSG:4326 or CRS84), or by `geodetic`. The tiles and the bounds
/// in the metadata show if a geodetic file has one root tile or two.
[[nodiscard]] Result<std::unique_ptr<TileSource>> open_mbtiles(const std::filesystem::path& path, bool geodetic);

}  // namespace terrella
