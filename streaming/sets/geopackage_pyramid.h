#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "base/result.h"
#include "streaming/sqlite_reader.h"
#include "tiles/tile_source.h"

namespace terrella {

/// Position of one level in the table. Rows and columns of the table count from the north-west corner of the tile
/// matrix set.
struct GeoPackageLevel {
  std::int64_t zoom = 0;
  std::int64_t columns = 0;
  std::int64_t rows = 0;
  std::int64_t first_column = 0;  ///< grid column of the table's column 0
  std::int64_t first_row = 0;     ///< grid row of the table's row 0; negative if the set begins north of 90°
  std::int64_t turn_columns = 0;  ///< columns in 360°; 0 if that is no whole number
};

/// A tile table as a tile set. Levels missing in the file are not in `levels`; their tiles are absent.
struct GeoPackageTiles {
  TileSetInfo info;
  std::string table;
  bool is_coverage = false;
  std::map<int, GeoPackageLevel> levels;
};

/// Finds the tiles in a GeoPackage: those that its table `terrella_tileset` describes, else the first tile table, else
/// the first gridded coverage (heights). A table in degrees gets a geodetic grid, pictures in EPSG:3857 Web Mercator,
/// and a table in another reference system a `projected` grid over its tile matrix set (gpkg_crs.h). The zoom levels
/// must halve. In degrees the corner must be a whole number of tiles from (-180°, 90°). Coarse levels that do not fit
/// are left out. OGC 12-128r18, clauses 2.2.6 to 2.2.8. The error begins with `where`.
[[nodiscard]] Result<GeoPackageTiles> read_geopackage(SqliteReader& reader, const std::string& where);

}  // namespace terrella
