#include "streaming/sets/gpkg_schema.h"

#include <algorithm>
#include <cmath>

#include "streaming/georeference/crs_text.h"
#include "streaming/sets/tileset_json.h"

namespace terrella {
namespace {

// clang-format off
constexpr const char* kTables[] = {
    "CREATE TABLE gpkg_spatial_ref_sys (srs_name TEXT NOT NULL, srs_id INTEGER NOT NULL PRIMARY KEY, "
    "organization TEXT NOT NULL, organization_coordsys_id INTEGER NOT NULL, definition TEXT NOT NULL, description TEXT)",
    "CREATE TABLE gpkg_contents (table_name TEXT NOT NULL PRIMARY KEY, data_type TEXT NOT NULL, identifier TEXT UNIQUE, "
    "description TEXT DEFAULT '', last_change DATETIME NOT NULL DEFAULT (strftime('%Y-%m-%dT%H:%M:%fZ','now')), "
    "min_x DOUBLE, min_y DOUBLE, max_x DOUBLE, max_y DOUBLE, srs_id INTEGER, "
    "CONSTRAINT fk_gc_r_srs_id FOREIGN KEY (srs_id) REFERENCES gpkg_spatial_ref_sys(srs_id))",
    "CREATE TABLE gpkg_tile_matrix_set (table_name TEXT NOT NULL PRIMARY KEY, srs_id INTEGER NOT NULL, "
    "min_x DOUBLE NOT NULL, min_y DOUBLE NOT NULL, max_x DOUBLE NOT NULL, max_y DOUBLE NOT NULL, "
    "CONSTRAINT fk_gtms_table_name FOREIGN KEY (table_name) REFERENCES gpkg_contents(table_name), "
    "CONSTRAINT fk_gtms_srs FOREIGN KEY (srs_id) REFERENCES gpkg_spatial_ref_sys(srs_id))",
    "CREATE TABLE gpkg_tile_matrix (table_name TEXT NOT NULL, zoom_level INTEGER NOT NULL, matrix_width INTEGER NOT NULL, "
    "matrix_height INTEGER NOT NULL, tile_width INTEGER NOT NULL, tile_height INTEGER NOT NULL, "
    "pixel_x_size DOUBLE NOT NULL, pixel_y_size DOUBLE NOT NULL, "
    "CONSTRAINT pk_ttm PRIMARY KEY (table_name, zoom_level), "
    "CONSTRAINT fk_tmm_table_name FOREIGN KEY (table_name) REFERENCES gpkg_contents(table_name))",
};

/// OGC 12-128r18, table 23.
constexpr const char* kExtensionsTable =
    "CREATE TABLE gpkg_extensions (table_name TEXT, column_name TEXT, extension_name TEXT NOT NULL, definition TEXT NOT NULL, "
    "scope TEXT NOT NULL, CONSTRAINT ge_tce UNIQUE (table_name, column_name, extension_name))";
/// OGC 12-128r18, annex F.7.
constexpr const char* kWebpExtension =
    "INSERT INTO gpkg_extensions VALUES ('tiles', 'tile_data', 'gpkg_webp', 'http://www.geopackage.org/spec/#extension_tiles_webp', "
    "'read-write')";

/// Tables of the extension, OGC 17-066r1, tables 1 to 3.
constexpr const char* kCoverageTables[] = {
    "CREATE TABLE gpkg_2d_gridded_coverage_ancillary (id INTEGER PRIMARY KEY AUTOINCREMENT NOT NULL, "
    "tile_matrix_set_name TEXT NOT NULL UNIQUE, datatype TEXT NOT NULL DEFAULT 'integer', scale REAL NOT NULL DEFAULT 1.0, "
    "offset REAL NOT NULL DEFAULT 0.0, precision REAL DEFAULT 1.0, data_null REAL, "
    "grid_cell_encoding TEXT DEFAULT 'grid-value-is-center', uom TEXT, field_name TEXT DEFAULT 'Height', "
    "quantity_definition TEXT DEFAULT 'Height', "
    "CONSTRAINT fk_g2dgtct_name FOREIGN KEY (tile_matrix_set_name) REFERENCES gpkg_tile_matrix_set(table_name), "
    "CHECK (datatype IN ('integer', 'float')))",
    "CREATE TABLE gpkg_2d_gridded_tile_ancillary (id INTEGER PRIMARY KEY AUTOINCREMENT NOT NULL, tpudt_name TEXT NOT NULL, "
    "tpudt_id INTEGER NOT NULL, scale REAL NOT NULL DEFAULT 1.0, offset REAL NOT NULL DEFAULT 0.0, min REAL DEFAULT NULL, "
    "max REAL DEFAULT NULL, mean REAL DEFAULT NULL, std_dev REAL DEFAULT NULL, "
    "CONSTRAINT fk_g2dgtat_name FOREIGN KEY (tpudt_name) REFERENCES gpkg_contents(table_name), UNIQUE (tpudt_name, tpudt_id))",
};

constexpr const char* kCoverageExtension =
    "INSERT INTO gpkg_extensions SELECT column1, column2, 'gpkg_2d_gridded_coverage', "
    "'http://docs.opengeospatial.org/is/17-066r1/17-066r1.html', 'read-write' FROM (VALUES "
    "('gpkg_2d_gridded_coverage_ancillary', NULL), ('gpkg_2d_gridded_tile_ancillary', NULL), ('tiles', 'tile_data'))";

constexpr const char* kReferenceSystems =
    "INSERT INTO gpkg_spatial_ref_sys VALUES "
    "('Undefined cartesian SRS', -1, 'NONE', -1, 'undefined', 'undefined cartesian coordinate reference system'), "
    "('Undefined geographic SRS', 0, 'NONE', 0, 'undefined', 'undefined geographic coordinate reference system'), "
    "('WGS 84 geodetic', 4326, 'EPSG', 4326, 'GEOGCS[\"WGS 84\",DATUM[\"WGS_1984\",SPHEROID[\"WGS 84\",6378137,"
    "298.257223563,AUTHORITY[\"EPSG\",\"7030\"]],AUTHORITY[\"EPSG\",\"6326\"]],PRIMEM[\"Greenwich\",0,AUTHORITY[\"EPSG\","
    "\"8901\"]],UNIT[\"degree\",0.0174532925199433,AUTHORITY[\"EPSG\",\"9122\"]],AXIS[\"Latitude\",NORTH],"
    "AXIS[\"Longitude\",EAST],AUTHORITY[\"EPSG\",\"4326\"]]', 'longitude and latitude in decimal degrees')";

constexpr const char* kWebMercator =
    "INSERT INTO gpkg_spatial_ref_sys VALUES "
    "('WGS 84 / Pseudo-Mercator', 3857, 'EPSG', 3857, 'PROJCS[\"WGS 84 / Pseudo-Mercator\",GEOGCS[\"WGS 84\","
    "DATUM[\"WGS_1984\",SPHEROID[\"WGS 84\",6378137,298.257223563,AUTHORITY[\"EPSG\",\"7030\"]],AUTHORITY[\"EPSG\","
    "\"6326\"]],PRIMEM[\"Greenwich\",0,AUTHORITY[\"EPSG\",\"8901\"]],UNIT[\"degree\",0.0174532925199433,AUTHORITY["
    "\"EPSG\",\"9122\"]],AUTHORITY[\"EPSG\",\"4326\"]],PROJECTION[\"Mercator_1SP\"],PARAMETER[\"central_meridian\",0],"
    "PARAMETER[\"scale_factor\",1],PARAMETER[\"false_easting\",0],PARAMETER[\"false_northing\",0],UNIT[\"metre\",1,"
    "AUTHORITY[\"EPSG\",\"9001\"]],AXIS[\"Easting\",EAST],AXIS[\"Northing\",NORTH],EXTENSION[\"PROJ4\",\"+proj=merc "
    "+a=6378137 +b=6378137 +lat_ts=0 +lon_0=0 +x_0=0 +y_0=0 +k=1 +units=m +nadgrids=@null +wktext +no_defs\"],AUTHORITY["
    "\"EPSG\",\"3857\"]]', 'Web Mercator')";
// clang-format on

/// srs_id of a system without a number of its own.
constexpr int kSrsOther = 100'000;

bool is_mercator(const TileGrid& grid) { return grid.projection == Projection::web_mercator; }

GridUnits units_of(const TileSetInfo& info) { return terrella::units_of(info.grid.projection, info.square); }

CrsIdentity identity_of(const CrsSquare& square) {
  const Result<CrsIdentity> known = identify_crs(square.crs);
  CrsIdentity identity = known ? *known : CrsIdentity{.name = "Unknown"};
  if (identity.code == 0) identity.code = kSrsOther;
  return identity;
}

int srs_of(const TileSetInfo& info) {
  if (info.square) return identity_of(*info.square).code;
  return is_mercator(info.grid) ? kSrsWebMercator : kSrsGeodetic;
}

SqlStatement reference_system(const CrsSquare& square) {
  const CrsIdentity identity = identity_of(square);
  return {.sql =
              "INSERT OR IGNORE INTO gpkg_spatial_ref_sys VALUES (?1, CAST(?4 AS INTEGER), ?2, CAST(?4 AS INTEGER), "
              "?3, NULL)",
          .texts = {identity.name, identity.authority, identity.wkt},
          .numbers = {static_cast<double>(identity.code)}};
}

}  // namespace

GridUnits units_of(Projection projection, const std::optional<CrsSquare>& square) {
  if (projection == Projection::web_mercator) return {.per_deg = kMercatorDegree_m};
  if (!square) return {};
  const double half = 180.0 * square->unit_per_deg;
  return {.per_deg = square->unit_per_deg, .x_of_0 = square->west + half, .y_of_0 = square->north - half};
}

namespace {

struct MatrixSize {
  double columns, rows, pixel;
};

MatrixSize matrix_size(const TileSetInfo& info, int level) {
  const TileGrid& grid = info.grid;
  if (info.square && !info.square->levels.empty()) {
    const CrsLevel& place = info.square->levels.at(static_cast<std::size_t>(level));
    return {static_cast<double>(place.columns), static_cast<double>(place.rows), place.unit_per_px};
  }
  return {.columns = std::ldexp(static_cast<double>(columns(grid, 0)), level),
          .rows = std::ldexp(static_cast<double>(rows(grid, 0)), level),
          .pixel = tile_span_deg(grid, level) / grid.tile_px * units_of(info).per_deg};
}

}  // namespace

SqlStatement tile_matrix_row(const TileSetInfo& info, int level) {
  const MatrixSize size = matrix_size(info, level);
  return {.sql =
              "INSERT INTO gpkg_tile_matrix VALUES ('tiles', CAST(?1 AS INTEGER), CAST(?2 AS INTEGER), "
              "CAST(?3 AS INTEGER), CAST(?4 AS INTEGER), CAST(?4 AS INTEGER), ?5, ?5)",
          .texts = {},
          .numbers = {static_cast<double>(level), size.columns, size.rows, static_cast<double>(info.grid.tile_px),
                      size.pixel}};
}

bool is_coverage(const TileSetInfo& info) { return info.numbers && !info.numbers->is_signed && !info.numbers->rgb; }

namespace {

/// True if the levels have other corners, for which a GeoPackage has no place.
bool has_moving_corners(const TileSetInfo& info) {
  return info.square && std::ranges::any_of(info.square->levels, [&](const CrsLevel& level) {
           return level.west != info.square->west || level.north != info.square->north;
         });
}

std::string data_type(const TileSetInfo& info) {
  if (has_moving_corners(info)) return kLevelsDataType;
  return is_coverage(info) ? "2d-gridded-coverage" : "tiles";
}

SqlStatement contents(const TileSetInfo& info, const std::string& last_change) {
  const GeoRect& bounds = info.grid.bounds;
  const bool crosses = bounds.east < bounds.west;
  const bool mercator = is_mercator(info.grid);
  const GridUnits units = units_of(info);
  const RowLatitudes rows = row_bounds(info.grid);
  return {
      .sql =
          "INSERT INTO gpkg_contents (table_name, data_type, identifier, description, last_change, min_x, min_y, "
          "max_x, max_y, srs_id) VALUES ('tiles', ?1, ?2, ?3, "
          "coalesce(nullif(?4, ''), strftime('%Y-%m-%dT%H:%M:%fZ', 'now')), ?5, ?6, ?7, ?8, CAST(?9 AS INTEGER))",
      .texts = {data_type(info), info.name.empty() ? "tiles" : info.name, info.attribution, last_change},
      .numbers = {units.x(crosses ? -180.0 : tidy_degrees(bounds.west)),
                  units.y(mercator ? rows.south_deg : tidy_degrees(bounds.south)),
                  units.x(crosses ? 180.0 : tidy_degrees(bounds.east)),
                  units.y(mercator ? rows.north_deg : tidy_degrees(bounds.north)), static_cast<double>(srs_of(info))}};
}

SqlStatement matrix_set(const TileSetInfo& info) {
  const TileGrid& grid = info.grid;
  const GridUnits units = units_of(info);
  const double top = top_row_deg(grid);
  return {
      .sql = "INSERT INTO gpkg_tile_matrix_set VALUES ('tiles', CAST(?1 AS INTEGER), ?2, ?3, ?4, ?5)",
      .texts = {},
      .numbers = {static_cast<double>(srs_of(info)), units.x(grid.west_deg),
                  units.y(top - static_cast<double>(rows(grid, 0)) * grid.root_span_deg),
                  units.x(grid.west_deg + static_cast<double>(columns(grid, 0)) * grid.root_span_deg), units.y(top)}};
}

void describe_numbers(const NumberInfo& info, std::vector<SqlStatement>& all) {
  for (const char* table : kCoverageTables) all.push_back({table, {}});
  all.push_back({kCoverageExtension, {}});
  std::vector<double> numbers = {info.scale, info.offset};
  // GDAL rounds to the precision. The schema's default is one metre.
  if (info.nodata) numbers.push_back(*info.nodata);
  const std::string quantity = info.quantity.empty() ? "value" : info.quantity;
  all.push_back({std::string("INSERT INTO gpkg_2d_gridded_coverage_ancillary (tile_matrix_set_name, datatype, scale, "
                             "offset, precision, data_null, uom, field_name, quantity_definition) VALUES ('tiles', " +
                             std::string(info.floats ? "'float'" : "'integer'") + ", ?3, ?4, abs(?3), ") +
                     (info.nodata ? "?5" : "NULL") + ", nullif(?1, ''), ?2, ?2)",
                 {info.unit, quantity},
                 std::move(numbers)});
}

}  // namespace

std::string tile_table_sql(const std::string& name) {
  return "CREATE TABLE " + name +
         " (id INTEGER PRIMARY KEY AUTOINCREMENT, zoom_level INTEGER NOT NULL, tile_column INTEGER NOT NULL, "
         "tile_row INTEGER NOT NULL, tile_data BLOB NOT NULL, UNIQUE (zoom_level, tile_column, tile_row))";
}

std::vector<SqlStatement> geopackage_schema(const TileSetInfo& info, const std::string& last_change,
                                            const std::string& cut_key) {
  const TileGrid& grid = info.grid;
  std::vector<SqlStatement> all;
  // 'GPKG', and version 1.3.0.
  all.push_back({"PRAGMA application_id = 1196444487", {}});
  all.push_back({"PRAGMA user_version = 10300", {}});
  for (const char* table : kTables) all.push_back({table, {}});
  all.push_back({tile_table_sql("tiles"), {}});
  all.push_back({kReferenceSystems, {}});
  if (is_mercator(grid)) all.push_back({kWebMercator, {}});
  if (info.square) all.push_back(reference_system(*info.square));
  all.push_back(contents(info, last_change));
  all.push_back(matrix_set(info));
  for (int level = grid.min_level; level <= grid.max_level; ++level) all.push_back(tile_matrix_row(info, level));
  all.push_back({std::string("CREATE TABLE ") + kTileSetTable + " (key TEXT PRIMARY KEY, value TEXT)", {}});
  all.push_back({std::string("INSERT INTO ") + kTileSetTable + " VALUES (?1, ?2)",
                 {kTileSetKey, to_tileset_json(info, cut_key)}});
  const bool webp = info.format == ImageFormat::webp;
  if (info.numbers || webp) all.push_back({kExtensionsTable, {}});
  if (webp) all.push_back({kWebpExtension, {}});
  if (is_coverage(info)) describe_numbers(*info.numbers, all);
  if (grid.reduced) all.push_back({tile_table_sql(kSqueezedTable), {}});
  return all;
}

}  // namespace terrella
