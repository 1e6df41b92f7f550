#include "streaming/geopackage_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <mutex>
#include <string_view>
#include <utility>
#include <vector>

#include "streaming/directory_source.h"
#include "streaming/file_bytes.h"
#include "streaming/geopackage_pyramid.h"
#include "streaming/sqlite_reader.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kSqliteMagic{"SQLite format 3\0", 16};

/// A tile is found through an index in dozens of steps; without one, these are enough to scan a few hundred thousand.
constexpr std::int64_t kMaxTileSteps = 2'000'000;

/// A connection and its two queries; used by one thread at a time.
struct Connection {
  SqliteReader reader;
  SqliteQuery tile;
  SqliteQuery count;
};

Result<Connection, SqlError> connect(SqliteReader reader, const std::string& table) {
  const std::string name = quote_identifier(table);
  Result<SqliteQuery, SqlError> tile =
      reader.prepare("SELECT tile_data FROM " + name + " WHERE zoom_level = ?1 AND tile_column = ?2 AND tile_row = ?3");
  if (!tile) return tile.error();
  Result<SqliteQuery, SqlError> count = reader.prepare("SELECT count(*) FROM " + name + " WHERE zoom_level = ?1");
  if (!count) return count.error();
  return Connection{std::move(reader), *std::move(tile), *std::move(count)};
}

/// The tile in the query's row. Copied, since it is gone once the query is reset.
Result<EncodedTile, TileFailure> tile_of(const SqliteQuery& query, bool row) {
  if (!row) return TileFailure{Absence::absent, "the GeoPackage has no such tile"};
  const auto blob = query.blob(0);
  if (!blob) return TileFailure{Absence::broken, "tile_data is not a blob"};
  if (blob->empty()) return TileFailure{Absence::blank, "tile_data is empty"};
  return EncodedTile{{blob->begin(), blob->end()}};
}

class GeoPackageSource : public TileSource {
 public:
  GeoPackageSource(fs::path path, GeoPackageTiles tiles, Connection first)
      : path_(std::move(path)), tiles_(std::move(tiles)) {
    idle_.push_back(std::move(first));
  }

  [[nodiscard]] const TileSetInfo& info() const override { return tiles_.info; }

  [[nodiscard]] Result<EncodedTile, TileFailure> read(const TileId& id) override {
    const auto level = tiles_.levels.find(id.level);
    if (!exists(tiles_.info.grid, id) || level == tiles_.levels.end()) {
      return TileFailure{Absence::absent, "outside the tile set"};
    }
    const auto place = place_of(level->second, id);
    if (!place) return TileFailure{Absence::absent, "outside the tile matrix"};
    if (given_up_) return TileFailure{Absence::broken, "given up: reading another tile took too long"};
    Result<Connection, SqlError> connection = take();
    if (!connection) return TileFailure{Absence::failed, connection.error().message};
    connection->tile.bind(1, level->second.zoom);
    connection->tile.bind(2, place->first);
    connection->tile.bind(3, place->second);
    const Result<bool, SqlError> row = connection->tile.step(kMaxTileSteps);
    Result<EncodedTile, TileFailure> tile = row ? tile_of(connection->tile, *row) : failure_of(row.error());
    connection->tile.reset();
    give_back(*std::move(connection));
    return tile;
  }

  [[nodiscard]] std::optional<std::int64_t> count_tiles(int level) override {
    const auto found = tiles_.levels.find(level);
    if (found == tiles_.levels.end()) return 0;
    Result<Connection, SqlError> connection = take();
    if (!connection) return std::nullopt;
    connection->count.bind(1, found->second.zoom);
    const Result<bool, SqlError> row = connection->count.step();
    const std::optional<std::int64_t> count = row && *row ? connection->count.integer(0) : std::nullopt;
    connection->count.reset();
    give_back(*std::move(connection));
    return count;
  }

 private:
  /// What never ends for one tile does not end for the next: a file is given one such chance.
  TileFailure failure_of(const SqlError& error) {
    if (error.problem == SqlProblem::too_long) given_up_ = true;
    return TileFailure{error.problem == SqlProblem::busy ? Absence::failed : Absence::broken, error.message};
  }

  static std::optional<std::pair<std::int64_t, std::int64_t>> place_of(const GeoPackageLevel& level, const TileId& id) {
    std::int64_t column = id.x - level.first_column;
    if (column < 0) column += level.turn_columns;
    const std::int64_t row = id.y - level.first_row;
    if (column < 0 || column >= level.columns || row < 0 || row >= level.rows) return std::nullopt;
    return std::pair(column, row);
  }

  Result<Connection, SqlError> take() {
    {
      const std::lock_guard lock(mutex_);
      if (!idle_.empty()) {
        Connection connection = std::move(idle_.back());
        idle_.pop_back();
        return connection;
      }
    }
    Result<SqliteReader, SqlError> reader = SqliteReader::open(path_, kMaxTileBytes);
    if (!reader) return reader.error();
    return connect(*std::move(reader), tiles_.table);
  }

  void give_back(Connection connection) {
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(connection));
  }

  const fs::path path_;
  const GeoPackageTiles tiles_;
  std::atomic<bool> given_up_ = false;
  std::mutex mutex_;
  std::vector<Connection> idle_;  ///< as many as there were readers at once; guarded by mutex_
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

Result<std::unique_ptr<TileSource>> open_geopackage(const fs::path& path) {
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
    if (mbtiles && *mbtiles)
      return Error{where + ": an MBTiles file; these are not read yet, write a GeoPackage instead"};
    return Error{where + ": an SQLite database, but not a GeoPackage (it has no table gpkg_contents)"};
  }
  Result<GeoPackageTiles> tiles = read_geopackage(*reader, where);
  if (!tiles) return tiles.error();
  Result<Connection, SqlError> connection = connect(*std::move(reader), tiles->table);
  if (!connection) {
    return Error{fmt::format("{}: the tile table \"{}\": {}", where, tiles->table, connection.error().message)};
  }
  return std::unique_ptr<TileSource>(
      std::make_unique<GeoPackageSource>(path, *std::move(tiles), *std::move(connection)));
}

}  // namespace terrella
