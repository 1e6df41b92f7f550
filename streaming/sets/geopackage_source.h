#pragma once

#include <filesystem>
#include <memory>

#include "tiles/tile_source.h"

namespace terrella {

/// True if the file begins as an SQLite database does. thread: any
[[nodiscard]] bool is_sqlite_file(const std::filesystem::path& path);

/// Opens a GeoPackage or an MBTiles file (mbtiles_source.h) for reading. Several threads may read at once, each on its
/// own connection.
[[nodiscard]] Result<std::unique_ptr<TileSource>> open_geopackage(const std::filesystem::path& path,
                                                                  bool geodetic_mbtiles = false);

}  // namespace terrella
