#pragma once

#include <filesystem>
#include <memory>

#include "base/result.h"
#include "tiles/tile_source.h"

namespace terrella {

/// Opens a tile set on disk: a directory (tileset.json or tilemapresource.xml), a GeoPackage in any system that PROJ
/// knows (ours, GDAL's), PMTiles, or MBTiles. `geodetic_mbtiles`: an MBTiles file is in the geodetic profile, whatever
/// it states. Sets in Web Mercator and `projected` sets become geodetic ones. The error
/// names the path, what is wrong, and what to do. Image files are cut first (streaming/cut.h). Blocks for the disk.
/// thread: any
[[nodiscard]] Result<std::unique_ptr<TileSource>> open_tile_set(const std::filesystem::path& path,
                                                                bool geodetic_mbtiles = false);

/// Opens a tile set for copying: sets in Web Mercator and `projected` sets keep their stored grid, which nothing can
/// draw. thread: any
[[nodiscard]] Result<std::unique_ptr<TileSource>> open_stored_tile_set(const std::filesystem::path& path,
                                                                       bool geodetic_mbtiles = false);

}  // namespace terrella
