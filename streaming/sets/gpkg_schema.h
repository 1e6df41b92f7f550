#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tiles/tile_source.h"

namespace terrella {

/// An SQL statement with the values of its parameters ?1, ?2 …
struct SqlStatement {
  std::string sql;
  std::vector<std::string> texts;    ///< bound first
  std::vector<double> numbers = {};  ///< bound after the texts
};

/// data_type of a table whose levels have corners of their own. Other programs find no tiles in it.
inline constexpr const char* kLevelsDataType = "terrella:levels";
inline constexpr int kSrsGeodetic = 4326;
inline constexpr int kSrsWebMercator = 3857;
/// Length of a degree of longitude in EPSG:3857, metres.
inline constexpr double kMercatorDegree_m = 6378137.0 * 3.14159265358979323846 / 180.0;

/// True if the tiles of the set are a gridded coverage, whose tiles have rows in a side table. The extension knows no
/// two's complement numbers; other programs see gray pictures of them.
[[nodiscard]] bool is_coverage(const TileSetInfo& info);

/// Statement that creates a tile table of this name (OGC 12-128r18, table 21).
[[nodiscard]] std::string tile_table_sql(const std::string& name);

/// Relation between a grid's degrees and the coordinates of its reference system: degrees, metres of Web Mercator, or
/// the units of a stored square (TileSetInfo::square).
struct GridUnits {
  double per_deg = 1.0;
  double x_of_0 = 0.0;
  double y_of_0 = 0.0;
  [[nodiscard]] double x(double deg) const { return x_of_0 + per_deg * deg; }
  [[nodiscard]] double y(double deg) const { return y_of_0 + per_deg * deg; }
};
[[nodiscard]] GridUnits units_of(Projection projection, const std::optional<CrsSquare>& square);

/// Statement that adds a level to gpkg_tile_matrix for the table `tiles`. Levels of a set may be added in any order.
[[nodiscard]] SqlStatement tile_matrix_row(const TileSetInfo& info, int level);

/// Statements that make an empty database a GeoPackage 1.3 (OGC 12-128r18) with an empty tile table `tiles` for the
/// set. They also store the set's own description in the side table `terrella_tileset`. Run them in order; they contain
/// no transaction. Sets in Web Mercator are declared in EPSG:3857, in metres; sets in a `projected` grid in the system
/// of their square, in its units.
/// The extent of the tile matrix set is matrix size × tile size × pixel size at every level, so it can reach beyond the
/// planet. gpkg_contents has the real bounds, but all longitudes if they cross ±180°, because an extent cannot cross
/// it. Heights make the table a tiled gridded coverage (OGC 17-066r1).
/// Squeezed tiles of a reduced grid are in the table kSqueezedTable, laid out like `tiles` and not listed in
/// gpkg_contents. A reader that does not know that table finds one tile table with every tile of the full grid.
/// `last_change` goes to gpkg_contents; empty: now. `cut_key`: see to_tileset_json().
[[nodiscard]] std::vector<SqlStatement> geopackage_schema(const TileSetInfo& info, const std::string& last_change = {},
                                                          const std::string& cut_key = {});

}  // namespace terrella
