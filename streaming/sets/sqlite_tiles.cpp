#include "streaming/sets/sqlite_tiles.h"

#include <utility>

#include "streaming/sets/directory_source.h"

namespace terrella {
namespace {

/// Returns the tile in the query's row, as a copy, because reset() frees the row.
Result<EncodedTile, TileFailure> tile_of(const SqliteQuery& query, bool row) {
  if (!row) return TileFailure{MissingKind::absent, "the file has no such tile"};
  const auto blob = query.blob(0);
  if (!blob) return TileFailure{MissingKind::broken, "tile_data is not a blob"};
  if (blob->empty()) return TileFailure{MissingKind::blank, "tile_data is empty"};
  return EncodedTile{.bytes = {blob->begin(), blob->end()},
                     .number_scale = query.number(1).value_or(1.0),
                     .number_offset = query.number(2).value_or(0.0)};
}

/// A tile without a row in the side table has a scale of 1 and an offset of 0.
std::string select_tile(const std::string& quoted_table, TileExtras extras) {
  const std::string place = " WHERE zoom_level = ?1 AND tile_column = ?2 AND tile_row = ?3";
  if (extras == TileExtras::none) return "SELECT tile_data, NULL, NULL FROM " + quoted_table + place;
  return "SELECT tile_data, a.scale, a.\"offset\" FROM " + quoted_table +
         " t LEFT JOIN gpkg_2d_gridded_tile_ancillary a ON a.tpudt_name = ?4 AND a.tpudt_id = t.id" + place;
}

/// Work limit for a list of rows. A row takes more than a byte of the file and a few microseconds. Only a hostile view
/// has more rows than the file has bytes, or takes a thousand times as long for many rows.
class ListAllowance {
 public:
  explicit ListAllowance(const std::filesystem::path& path) {
    std::error_code failed;
    const auto bytes = std::filesystem::file_size(path, failed);
    rows_left_ = failed ? 0 : static_cast<std::int64_t>(bytes);
  }

  Result<bool, SqlError> step(SqliteQuery& query) {
    const double begun_s = thread_seconds();
    const Result<bool, SqlError> more = query.step();
    seconds_left_ += kSecondsPerRow - (thread_seconds() - begun_s);
    if (--rows_left_ >= 0 && seconds_left_ > 0.0) return more;
    return SqlError{SqlProblem::too_long, "listing its rows takes too long (a hostile view)"};
  }

 private:
  static constexpr double kSecondsPerRow = 1e-3;
  std::int64_t rows_left_ = 0;
  double seconds_left_ = kMaxRowSeconds;
};

}  // namespace

Result<std::unique_ptr<SqliteTiles>, SqlError> SqliteTiles::open(std::filesystem::path path, std::string table,
                                                                 TileExtras extras) {
  std::unique_ptr<SqliteTiles> tiles(new SqliteTiles(std::move(path), std::move(table), extras));
  Result<Connection, SqlError> first = tiles->connect();
  if (!first) return first.error();
  tiles->give_back(*std::move(first));
  return tiles;
}

Result<SqliteTiles::Connection, SqlError> SqliteTiles::connect() const {
  Result<SqliteReader, SqlError> reader = SqliteReader::open(path_, kMaxTileBytes);
  if (!reader) return reader.error();
  const std::string name = quote_identifier(table_);
  Result<SqliteQuery, SqlError> tile = reader->prepare(select_tile(name, extras_));
  if (!tile) return tile.error();
  Result<SqliteQuery, SqlError> count = reader->prepare("SELECT count(*) FROM " + name + " WHERE zoom_level = ?1");
  if (!count) return count.error();
  return Connection{*std::move(reader), *std::move(tile), *std::move(count)};
}

Result<EncodedTile, TileFailure> SqliteTiles::read(const SqlitePlace& place) {
  if (given_up_) return TileFailure{MissingKind::broken, "given up: reading another tile took too long"};
  Result<Connection, SqlError> connection = take();
  if (!connection) return TileFailure{MissingKind::failed, connection.error().message};
  connection->tile.bind(1, place.zoom);
  connection->tile.bind(2, place.column);
  connection->tile.bind(3, place.row);
  if (extras_ == TileExtras::coverage) connection->tile.bind(4, table_);
  const Result<bool, SqlError> row = connection->tile.step(kMaxTileSteps);
  Result<EncodedTile, TileFailure> tile = row ? tile_of(connection->tile, *row) : failure_of(row.error());
  connection->tile.reset();
  give_back(*std::move(connection));
  return tile;
}

std::optional<std::int64_t> SqliteTiles::count(std::int64_t zoom) {
  Result<Connection, SqlError> connection = take();
  if (!connection) return std::nullopt;
  connection->count.bind(1, zoom);
  const Result<bool, SqlError> row = connection->count.step();
  const std::optional<std::int64_t> count = row && *row ? connection->count.integer(0) : std::nullopt;
  connection->count.reset();
  give_back(*std::move(connection));
  return count;
}

Result<bool, SqlError> SqliteTiles::for_each(std::int64_t zoom,
                                             const std::function<bool(std::int64_t, std::int64_t)>& call) const {
  Result<SqliteReader, SqlError> reader = SqliteReader::open(path_, kMaxTileBytes);
  if (!reader) return reader.error();
  Result<SqliteQuery, SqlError> query =
      reader->prepare("SELECT tile_column, tile_row FROM " + quote_identifier(table_) + " WHERE zoom_level = ?1");
  if (!query) return query.error();
  query->bind(1, zoom);
  ListAllowance allowance(path_);
  Result<bool, SqlError> more = allowance.step(*query);
  for (; more && *more; more = allowance.step(*query)) {
    const auto column = query->integer(0), row = query->integer(1);
    if (column && row && !call(*column, *row)) return false;
  }
  if (!more) return more.error();
  return true;
}

/// After one query without end, the file is given up, because the next tile would take as long.
TileFailure SqliteTiles::failure_of(const SqlError& error) {
  if (error.problem == SqlProblem::too_long) given_up_ = true;
  return TileFailure{error.problem == SqlProblem::busy ? MissingKind::failed : MissingKind::broken, error.message};
}

Result<SqliteTiles::Connection, SqlError> SqliteTiles::take() {
  {
    const std::lock_guard lock(mutex_);
    if (!idle_.empty()) {
      Connection connection = std::move(idle_.back());
      idle_.pop_back();
      return connection;
    }
  }
  return connect();
}

void SqliteTiles::give_back(Connection connection) {
  const std::lock_guard lock(mutex_);
  idle_.push_back(std::move(connection));
}

}  // namespace terrella
