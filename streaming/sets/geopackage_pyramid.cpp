#include "streaming/sets/geopackage_pyramid.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "streaming/sets/geopackage_matrix.h"
#include "streaming/sets/gpkg_coverage.h"
#include "streaming/sets/gpkg_crs.h"
#include "streaming/sets/gpkg_schema.h"
#include "streaming/sets/tileset_json.h"
#include "tiles/grid_ranges.h"
#include "tiles/tile_range.h"

namespace terrella {
namespace {

constexpr double kMaxCoordinateDeg = 1e6;
constexpr double kMaxCoordinate = 1e12;  // in any unit
constexpr int kMaxTables = 1000;

/// A row of gpkg_contents with its row of gpkg_tile_matrix_set.
struct TileTable {
  std::string name, identifier, description;
  Extent set;
  std::optional<Extent> data;
  bool is_coverage = false;
  GpkgCrs crs;                           ///< reference system; Terrella's own files have only its projection
  std::optional<CrsSquare> square = {};  ///< square of a projected table
  GridUnits units = {};                  ///< units of the table's reference system
};

std::optional<CrsBounds> get_bounds(const SqliteQuery& query, int first_column) {
  std::array<double, 4> sides{};
  for (int i = 0; i < 4; ++i) {
    const std::optional<double> side = query.number(first_column + i);
    if (!side || std::abs(*side) > kMaxCoordinate) return std::nullopt;
    sides[static_cast<std::size_t>(i)] = *side;
  }
  const CrsBounds bounds{sides[0], sides[1], sides[2], sides[3]};
  return bounds.west < bounds.east && bounds.south < bounds.north ? std::optional(bounds) : std::nullopt;
}

std::optional<Extent> in_degrees(const std::optional<CrsBounds>& bounds, const GridUnits& units) {
  if (!bounds) return std::nullopt;
  const auto x = [&](double side) { return (side - units.x_of_0) / units.per_deg; };
  const auto y = [&](double side) { return (side - units.y_of_0) / units.per_deg; };
  const Extent extent{x(bounds->west), y(bounds->south), x(bounds->east), y(bounds->north)};
  for (const double side : {extent.west, extent.south, extent.east, extent.north}) {
    if (!(std::abs(side) <= kMaxCoordinateDeg)) return std::nullopt;
  }
  return extent;
}

/// The square from the corner of a tile matrix set that holds it.
CrsSquare square_over(const CrsBounds& set, const std::string& crs) {
  const double side = std::max(set.east - set.west, set.north - set.south);
  return {.crs = crs, .west = set.west, .north = set.north, .unit_per_deg = side / 360.0};
}

/// Finds the reference system of a table. `ours` is Terrella's own description, or null.
Status find_system(SqliteReader& reader, std::int64_t srs_id, const CrsBounds& set, const TileSetInfo* ours,
                   TileTable& table) {
  if (ours != nullptr && ours->square) {
    table.crs.projection = Projection::projected;
    table.square = ours->square;
  } else if (Result<GpkgCrs> crs = read_gpkg_crs(reader, srs_id, set, table.is_coverage && ours == nullptr); crs) {
    table.crs = *std::move(crs);
    if (table.crs.projection == Projection::projected && ours == nullptr) {
      table.square = square_over(set, table.crs.text);
    }
  } else if (ours == nullptr) {
    return crs.error();
  }
  table.units = units_of(table.crs.projection, table.square);
  return Done{};
}

Result<TileTable> get_table(SqliteReader& reader, const SqliteQuery& query, const TileSetInfo* ours,
                            const std::string& where) {
  const std::optional<std::string> name = query.text(0);
  if (!name) return Error{where + ": gpkg_contents: a table_name is not a text"};
  const std::optional<std::int64_t> srs_id = query.integer(3);
  if (!srs_id)
    return Error{fmt::format("{}: gpkg_tile_matrix_set: the srs_id of \"{}\" is not a whole number", where, *name)};
  TileTable table{.name = *name,
                  .identifier = query.text(1).value_or(*name),
                  .description = query.text(2).value_or(""),
                  .set = {},
                  .data = {},
                  .is_coverage = query.text(12) == kCoverageDataType,
                  .crs = {}};
  const std::optional<CrsBounds> set = get_bounds(query, 8);
  if (set) {
    if (Status found = find_system(reader, *srs_id, *set, ours, table); !found) {
      return Error{fmt::format("{}: the {} of \"{}\" are {}", where, table.is_coverage ? "heights" : "tiles", *name,
                               found.error().message)};
    }
  }
  const std::optional<Extent> extent = in_degrees(set, table.units);
  if (!extent) {
    return Error{
        fmt::format("{}: gpkg_tile_matrix_set: min_x, min_y, max_x, max_y of \"{}\" are not the corners of a "
                    "rectangle in its reference system",
                    where, *name)};
  }
  table.set = *extent;
  table.data = in_degrees(get_bounds(query, 4), table.units);
  return table;
}

/// First usable tile table, pictures before heights. In a file of Terrella's, whose description is `ours`, any
/// reference system is usable.
Result<TileTable> find_table(SqliteReader& reader, const TileSetInfo* ours, const std::string& where) {
  Result<SqliteQuery, SqlError> query = reader.prepare(
      "SELECT c.table_name, c.identifier, c.description, m.srs_id, c.min_x, c.min_y, c.max_x, c.max_y, m.min_x, "
      "m.min_y, "
      "m.max_x, m.max_y, c.data_type FROM gpkg_contents c JOIN gpkg_tile_matrix_set m ON m.table_name = c.table_name "
      "WHERE c.data_type IN ('tiles', '2d-gridded-coverage') ORDER BY c.data_type DESC");
  if (!query) return Error{fmt::format("{}: not a GeoPackage with tiles: {}", where, query.error().message)};
  std::optional<Error> refused;
  for (int i = 0; i < kMaxTables; ++i) {
    const Result<bool, SqlError> more = query->step();
    if (!more) return Error{fmt::format("{}: gpkg_contents: {}", where, more.error().message)};
    if (!*more) break;
    Result<TileTable> table = get_table(reader, *query, ours, where);
    if (table) return table;
    if (!refused) refused = table.error();
  }
  if (refused) return *refused;
  return Error{where + ": a GeoPackage without tiles (gpkg_contents names no table of the data_type 'tiles')"};
}

/// Bounds of an extent. Longitudes beyond 180° (0 to 360 is common for planets) are wrapped.
GeoRect bounds_of(const Extent& extent) {
  const double width = extent.east - extent.west;
  const auto wrap = [](double lon) { return lon > 180.0 ? lon - 360.0 : (lon < -180.0 ? lon + 360.0 : lon); };
  const bool whole_turn = width >= 360.0;
  const bool shifted = extent.west >= -180.0 && extent.west < 180.0 && extent.east > 180.0;
  const double west = whole_turn ? -180.0 : std::clamp(extent.west, -180.0, 180.0);
  const double east = whole_turn ? 180.0 : (shifted ? wrap(extent.east) : std::clamp(extent.east, -180.0, 180.0));
  return {.west = Angle::degrees(west),
          .south = Angle::degrees(std::clamp(extent.south, -90.0, 90.0)),
          .east = Angle::degrees(east),
          .north = Angle::degrees(std::clamp(extent.north, -90.0, 90.0))};
}

/// Bounds of an extent in the degrees of a square.
GeoRect bounds_in_square(const Extent& extent) {
  const auto within = [](double side) { return Angle::degrees(std::clamp(side, -180.0, 180.0)); };
  return {.west = within(extent.west),
          .south = within(extent.south),
          .east = within(extent.east),
          .north = within(extent.north)};
}

Extent in_latitude(Extent extent, Projection projection) {
  if (projection != Projection::web_mercator) return extent;
  extent.south = latitude_of_mercator_row_deg(extent.south);
  extent.north = latitude_of_mercator_row_deg(extent.north);
  return extent;
}

/// Format of the first tile in the table. The format is only informative; decoders look at the bytes.
ImageFormat format_of(SqliteReader& reader, const std::string& table) {
  Result<SqliteQuery, SqlError> query =
      reader.prepare("SELECT tile_data FROM " + quote_identifier(table) + " WHERE typeof(tile_data) = 'blob' LIMIT 1");
  if (!query) return ImageFormat::unknown;
  const Result<bool, SqlError> row = query->step();
  return row && *row ? sniff_format(query->blob(0).value_or(std::span<const std::byte>{})) : ImageFormat::unknown;
}

/// Limit of root tiles. A viewer keeps the tiles of the coarsest level in memory.
constexpr std::int64_t kMaxRootTiles = 512;

Result<bool, SqlError> has_tiles(SqliteReader& reader, const std::string& table, std::int64_t zoom) {
  Result<SqliteQuery, SqlError> query =
      reader.prepare("SELECT 1 FROM " + quote_identifier(table) + " WHERE zoom_level = ?1 LIMIT 1");
  if (!query) return query.error();
  query->bind(1, zoom);
  return query->step();
}

/// Drops empty coarse levels. gdal_translate lists all zoom levels but writes only the finest; gdaladdo fills the
/// others.
Status drop_empty_levels(SqliteReader& reader, GeoPackageTiles& tiles, const std::string& where) {
  while (!tiles.levels.empty()) {
    const Result<bool, SqlError> some = has_tiles(reader, tiles.table, tiles.levels.begin()->second.zoom);
    if (!some) return Error{fmt::format("{}: the tile table \"{}\": {}", where, tiles.table, some.error().message)};
    if (*some) break;
    tiles.levels.erase(tiles.levels.begin());
  }
  if (tiles.levels.empty()) return Error{fmt::format("{}: the tile table \"{}\" holds no tiles", where, tiles.table)};
  TileGrid& grid = tiles.info.grid;
  grid.min_level = tiles.levels.begin()->first;
  const std::int64_t roots = count_places(grid, grid.min_level);
  if (roots > kMaxRootTiles) {
    return Error{
        fmt::format("{}: its coarsest tiles are {} in number, at most {} can be a base: add overviews with `gdaladdo "
                    "{} 2 4 8 16`",
                    where, roots, kMaxRootTiles, where)};
  }
  return Done{};
}

/// Text of Terrella's side table, if it exists.
Result<std::optional<std::string>> read_description(SqliteReader& reader, const std::string& where) {
  const Result<bool, SqlError> ours = reader.has_table(kTileSetTable);
  if (!ours) return Error{fmt::format("{}: {}", where, ours.error().message)};
  if (!*ours) return std::optional<std::string>{};
  Result<SqliteQuery, SqlError> query =
      reader.prepare(fmt::format("SELECT value FROM {} WHERE key = '{}'", kTileSetTable, kTileSetKey));
  const auto refuse = [&](const std::string& why) {
    return Error{fmt::format("{}: {}: {}", where, kTileSetTable, why)};
  };
  if (!query) return refuse(query.error().message);
  const Result<bool, SqlError> row = query->step();
  if (!row) return refuse(row.error().message);
  std::optional<std::string> text = *row ? query->text(0) : std::nullopt;
  if (!text) return refuse(fmt::format("no text under the key '{}'", kTileSetKey));
  return text;
}

/// The table of a file of Terrella's whose levels have places of their own. Their numbers are the zoom levels.
GeoPackageTiles with_own_levels(GeoPackageTiles tiles) {
  tiles.table = "tiles";
  const TileGrid& grid = tiles.info.grid;
  for (int level = grid.min_level; level <= grid.max_level; ++level) {
    const CrsLevel& place = tiles.info.square->levels[static_cast<std::size_t>(level)];
    tiles.levels[level] = {.zoom = level, .columns = place.columns, .rows = place.rows};
  }
  return tiles;
}

/// Describes the set of a table that has no description of Terrella's.
Status describe_table(SqliteReader& reader, const TileTable& table, TileSetInfo& info, const std::string& where) {
  info.name = table.identifier;
  info.attribution = table.description;
  info.body = table.crs.body;
  info.square = table.square;
  info.grid.projection = table.crs.projection;
  info.grid.latitude = table.crs.latitude;
  const Extent data = table.data.value_or(table.set);
  info.grid.bounds = table.square ? bounds_in_square(data) : bounds_of(in_latitude(data, table.crs.projection));
  info.format = format_of(reader, table.name);
  if (!table.is_coverage) return Done{};
  const Result<NumberInfo> elevation = read_coverage(reader, table.name, where);
  if (!elevation) return elevation.error();
  info.numbers = *elevation;
  return Done{};
}

}  // namespace

Result<GeoPackageTiles> read_geopackage(SqliteReader& reader, const std::string& where) {
  const Result<std::optional<std::string>> description = read_description(reader, where);
  if (!description) return description.error();
  const bool ours = description->has_value();
  GeoPackageTiles tiles;
  if (ours) {
    Result<TileSetInfo> info = parse_tileset_json(**description, fmt::format("{}: {}", where, kTileSetTable));
    if (!info) return info.error();
    tiles.info = *std::move(info);
  }
  if (tiles.info.square && !tiles.info.square->levels.empty()) return with_own_levels(std::move(tiles));
  const Result<TileTable> table = find_table(reader, ours ? &tiles.info : nullptr, where);
  if (!table) return table.error();
  const auto matrices = read_matrices(reader, {table->name, 1.0 / table->units.per_deg}, table->set, where);
  if (!matrices) return matrices.error();

  tiles.table = table->name;
  tiles.is_coverage = table->is_coverage;
  if (ours) {
    const bool mercator = tiles.info.grid.projection == Projection::web_mercator;
    if (mercator != (table->crs.projection == Projection::web_mercator)) {
      return Error{fmt::format(
          "{}: its description and its gpkg_tile_matrix_set differ on whether it is in Web Mercator", where)};
    }
    if (Status matched = match_grid(*matrices, table->set, tiles, where); !matched) return matched.error();
    return tiles;
  }
  if (Status described = describe_table(reader, *table, tiles.info, where); !described) return described.error();
  if (Status placed = place_on_grid(*matrices, table->set, tiles, where); !placed) return placed.error();
  if (Status grid = check_grid(tiles.info.grid, where); !grid) return grid.error();
  if (Status filled = drop_empty_levels(reader, tiles, where); !filled) return filled.error();
  return tiles;
}

}  // namespace terrella
