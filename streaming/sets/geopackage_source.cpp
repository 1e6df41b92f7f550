#include "streaming/sets/geopackage_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>
#include <vector>

#include "streaming/file_bytes.h"
#include "streaming/sets/directory_source.h"
#include "streaming/sets/geopackage_pyramid.h"
#include "streaming/sets/mbtiles_source.h"
#include "streaming/sets/sqlite_tiles.h"
#include "streaming/sets/tileset_json.h"
#include "streaming/sqlite_reader.h"
#include "streaming/tile_lister.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kSqliteMagic{"SQLite format 3\0", 16};

class GeoPackageSource : public TileSource, public TileLister {
 public:
  GeoPackageSource(fs::path path, GeoPackageTiles tiles, std::unique_ptr<SqliteTiles> table,
                   std::unique_ptr<SqliteTiles> squeezed)
      : path_(std::move(path)), tiles_(std::move(tiles)), table_(std::move(table)), squeezed_(std::move(squeezed)) {}

  [[nodiscard]] const TileSetInfo& info() const override { return tiles_.info; }

  [[nodiscard]] Result<EncodedTile, TileFailure> read(const TileId& id) override {
    const auto level = tiles_.levels.find(id.level);
    if (!exists(tiles_.info.grid, id) || level == tiles_.levels.end()) {
      return TileFailure{MissingKind::absent, "outside the tile set"};
    }
    if (id.squeeze != 0) return squeezed_->read({.zoom = level->second.zoom, .column = id.x, .row = id.y});
    const auto place = place_of(level->second, id);
    if (!place) return TileFailure{MissingKind::absent, "outside the tile matrix"};
    return table_->read({.zoom = level->second.zoom, .column = place->first, .row = place->second});
  }

  [[nodiscard]] std::optional<std::int64_t> count_tiles(int level) override {
    const auto found = tiles_.levels.find(level);
    return found == tiles_.levels.end() ? 0 : table_->count(found->second.zoom);
  }

  [[nodiscard]] Status for_each_tile(const std::function<bool(const TileId&)>& call) override {
    for (const auto& [level, place] : tiles_.levels) {
      auto more = table_->for_each(place.zoom, [&, at = place, level = level](std::int64_t column, std::int64_t row) {
        if (column < 0 || column >= at.columns || row < 0 || row >= at.rows) return true;
        const TileId id = tile_at(at, level, column, row);
        return !exists(tiles_.info.grid, id) || call(id);
      });
      if (more && *more && squeezed_) {
        more = squeezed_->for_each(place.zoom, [&, level = level](std::int64_t column, std::int64_t row) {
          const TileId id = squeezed_tile_at(level, column, row);
          return id.squeeze == 0 || !exists(tiles_.info.grid, id) || call(id);
        });
      }
      if (!more) return Error{fmt::format("{}: its tiles cannot be listed: {}", path_.string(), more.error().message)};
      if (!*more) return Done{};
    }
    return Done{};
  }

 private:
  /// Inverse of place_of().
  static TileId tile_at(const GeoPackageLevel& at, int level, std::int64_t column, std::int64_t row) {
    const std::int64_t x = column + at.first_column;
    const bool beyond = at.turn_columns > 0 && x >= at.turn_columns;
    return {.level = level, .x = beyond ? x - at.turn_columns : x, .y = row + at.first_row};
  }

  [[nodiscard]] TileId squeezed_tile_at(int level, std::int64_t column, std::int64_t row) const {
    const TileGrid& grid = tiles_.info.grid;
    const bool on_grid = row >= 0 && row < rows(grid, level);
    return {.level = level, .x = column, .y = row, .squeeze = on_grid ? squeeze_of_row(grid, level, row) : 0};
  }

  static std::optional<std::pair<std::int64_t, std::int64_t>> place_of(const GeoPackageLevel& level, const TileId& id) {
    std::int64_t column = id.x - level.first_column;
    if (column < 0) column += level.turn_columns;
    const std::int64_t row = id.y - level.first_row;
    if (column < 0 || column >= level.columns || row < 0 || row >= level.rows) return std::nullopt;
    return std::pair(column, row);
  }

  const fs::path path_;
  const GeoPackageTiles tiles_;
  const std::unique_ptr<SqliteTiles> table_;
  const std::unique_ptr<SqliteTiles> squeezed_;  ///< null unless the grid is reduced
};

Result<bool, SqlError> is_mbtiles(SqliteReader& reader) {
  Result<bool, SqlError> tiles = reader.has_table("tiles");
  if (!tiles || !*tiles) return tiles;
  return reader.has_table("metadata");
}

}  // namespace

bool is_sqlite_file(const fs::path& path) {
  const auto head = read_head(path, kSqliteMagic.size());
  if (!head) return false;
  return std::equal(head->begin(), head->end(), kSqliteMagic.begin(), kSqliteMagic.end(),
                    [](std::byte a, char b) { return static_cast<char>(a) == b; });
}

Result<std::unique_ptr<TileSource>> open_geopackage(const fs::path& path, bool geodetic_mbtiles) {
  const std::string where = path.string();
  const auto not_readable = [&](const SqlError& error) {
    return Error{fmt::format("{}: cannot be read as a GeoPackage: {}", where, error.message)};
  };
  Result<SqliteReader, SqlError> reader = SqliteReader::open(path, kMaxTileBytes);
  if (!reader) return not_readable(reader.error());
  const Result<bool, SqlError> is_geopackage = reader->has_table("gpkg_contents");
  if (!is_geopackage) return not_readable(is_geopackage.error());
  if (!*is_geopackage) {
    const Result<bool, SqlError> mbtiles = is_mbtiles(*reader);
    if (mbtiles && *mbtiles) return open_mbtiles(path, geodetic_mbtiles);
    return Error{where +
                 ": an SQLite database, but neither a GeoPackage (it has no table gpkg_contents) nor MBTiles (it "
                 "has no tables metadata and tiles)"};
  }
  Result<GeoPackageTiles> tiles = read_geopackage(*reader, where);
  if (!tiles) return tiles.error();
  Result<std::unique_ptr<SqliteTiles>, SqlError> table =
      SqliteTiles::open(path, tiles->table, tiles->is_coverage ? TileExtras::coverage : TileExtras::none);
  if (!table) return Error{fmt::format("{}: the tile table \"{}\": {}", where, tiles->table, table.error().message)};
  std::unique_ptr<SqliteTiles> squeezed;
  if (tiles->info.grid.reduced) {
    auto opened = SqliteTiles::open(path, kSqueezedTable);
    if (!opened)
      return Error{fmt::format("{}: the tile table \"{}\": {}", where, kSqueezedTable, opened.error().message)};
    squeezed = *std::move(opened);
  }
  return std::unique_ptr<TileSource>(
      std::make_unique<GeoPackageSource>(path, *std::move(tiles), *std::move(table), std::move(squeezed)));
}

}  // namespace terrella
