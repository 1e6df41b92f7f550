#pragma once

#include <filesystem>
#include <memory>

#include "base/result.h"
#include "tiles/tile_source.h"

namespace terrella {

/// Opens a tile set on disk: a directory (tileset.json or tilemapresource.xml), a GeoPackage in EPSG:4326 or EPSG:3857
/// (Terrella's, GDAL's), or MBTiles. `geodetic_mbtiles` treats an MBTiles file as geodetic, whatever its metadata say.
/// Sets in Web Mercator become geodetic (streaming/mercator/mercator_source.h). The error names the path, the fault and
/// a cure. Image files must be cut first (streaming/cut.h).
[[nodiscard]] Result<std::unique_ptr<TileSource>> open_tile_set(const std::filesystem::path& path,
                                                                bool geodetic_mbtiles = false);

/// Like open_tile_set(), but leaves sets in Web Mercator as stored. Nothing can draw such a grid; use this to copy
/// tiles.
[[nodiscard]] Result<std::unique_ptr<TileSource>> open_stored_tile_set(const std::filesystem::path& path,
                                                                       bool geodetic_mbtiles = false);

}  // namespace terrella
