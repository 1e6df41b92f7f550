#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "base/result.h"
#include "streaming/sqlite_reader.h"
#include "tiles/tile_source.h"

namespace terrella {

/// Where the tiles of one level stand in the table: row and column count from the tile matrix set's own north-west
/// corner.
struct GeoPackageLevel {
  std::int64_t zoom = 0;
  std::int64_t columns = 0;
  std::int64_t rows = 0;
  std::int64_t first_column = 0;  ///< the grid's column of the table's column 0
  std::int64_t first_row = 0;     ///< the grid's row of the table's row 0; negative if the set begins north of 90°
  std::int64_t turn_columns = 0;  ///< columns in 360°, 0 if that is no whole number
};

/// A tile table as a tile set. Levels that the file lacks between others are not in `levels`: their tiles are absent.
struct GeoPackageTiles {
  TileSetInfo info;
  std::string table;
  bool is_coverage = false;
  std::map<int, GeoPackageLevel> levels;
};

/// Finds the tiles in a GeoPackage: those that its table `terrella_tileset` describes, else the first tile table, or if
/// there is none the first gridded coverage (heights), in EPSG:4326 whose zoom levels halve and whose corner is a whole
/// number of tiles from (-180°, 90°); coarse levels for which it is not are left out. OGC 12-128r18, clauses 2.2.6
/// to 2.2.8. The error begins with `where`.
[[nodiscard]] Result<GeoPackageTiles> read_geopackage(SqliteReader& reader, const std::string& where);

}  // namespace terrella
