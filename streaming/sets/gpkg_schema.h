#pragma once

#include <string>
#include <vector>

#include "tiles/tile_source.h"

namespace terrella {

/// A statement of SQL with the values of its parameters ?1, ?2 …
struct SqlStatement {
  std::string sql;
  std::vector<std::string> texts;    ///< bound first
  std::vector<double> numbers = {};  ///< bound after the texts
};

inline constexpr int kSrsGeodetic = 4326;
inline constexpr int kSrsWebMercator = 3857;
/// What a degree of longitude is in EPSG:3857, metres.
inline constexpr double kMercatorDegree_m = 6378137.0 * 3.14159265358979323846 / 180.0;

/// What makes a tile table of this name (OGC 12-128r18, table 21).
[[nodiscard]] std::string tile_table_sql(const std::string& name);

/// What adds a level to gpkg_tile_matrix, for the table `tiles`. A grid's levels may be added in any order.
[[nodiscard]] SqlStatement tile_matrix_row(const TileGrid& grid, int level);

/// What makes an empty database a GeoPackage 1.3 (OGC 12-128r18) with an empty tile table `tiles` for the set, and with
/// the set's own description in the side table `terrella_tileset`. In order; no transaction of its own. Sets in Web
/// Mercator are declared in EPSG:3857, in its metres.
/// The tile matrix set's extent is matrix size × tile size × pixel size at every level, so it can reach beyond the
/// planet; what there is stands in gpkg_contents, with all longitudes if it crosses ±180°, as an extent cannot.
/// Heights make it a tiled gridded coverage (OGC 17-066r1). Squeezed tiles of a reduced grid have the table
/// kSqueezedTable, laid out as `tiles` and not named in gpkg_contents: a reader that knows nothing of it finds one tile
/// table, with every tile of the full grid. `last_change` goes to gpkg_contents; empty: now. `cut_key`: as of
/// to_tileset_json().
[[nodiscard]] std::vector<SqlStatement> geopackage_schema(const TileSetInfo& info, const std::string& last_change = {},
                                                          const std::string& cut_key = {});

}  // namespace terrella
