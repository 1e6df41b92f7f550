#include "streaming/cache/cache_reader.h"

#include <fmt/format.h>

#include <utility>

#include "streaming/cache/cache_schema.h"
#include "streaming/sets/directory_source.h"

namespace terrella {
namespace {

/// A single statement reads tile and missing-tile record at the same moment. While one replaces the other, a reader
/// therefore never misses both.
std::string find_sql(const char* data) {
  return fmt::format(
      "SELECT {}, t.id, NULL, '', s.etag, s.last_modified, s.stored, s.expires, s.used FROM tiles t "
      "LEFT JOIN terrella_cache_tiles s ON s.id = t.id WHERE zoom_level = ?1 AND tile_column = ?2 AND tile_row = ?3 "
      "UNION ALL SELECT NULL, NULL, kind, why, etag, last_modified, stored, expires, NULL FROM terrella_cache_absences "
      "WHERE zoom_level = ?1 AND tile_column = ?2 AND tile_row = ?3",
      data);
}

/// The same for the rows of a column, which are adjacent in the existing index of the tile table.
constexpr const char* kColumnSql =
    "SELECT NULL, t.id, NULL, '', s.etag, s.last_modified, s.stored, s.expires, s.used, t.tile_row FROM tiles t "
    "LEFT JOIN terrella_cache_tiles s ON s.id = t.id WHERE zoom_level = ?1 AND tile_column = ?2 AND tile_row BETWEEN "
    "?3 "
    "AND ?4 UNION ALL SELECT NULL, NULL, kind, why, etag, last_modified, stored, expires, NULL, tile_row "
    "FROM terrella_cache_absences WHERE zoom_level = ?1 AND tile_column = ?2 AND tile_row BETWEEN ?3 AND ?4 "
    "ORDER BY tile_row";

FoundRecord record_of(const SqliteQuery& query) {
  FoundRecord found;
  CacheRecord& record = found.record;
  if (const auto bytes = query.blob(0)) record.bytes.assign(bytes->begin(), bytes->end());
  found.row = query.integer(1);
  if (const auto kind = query.text(2)) record.missing = missing_named(*kind);
  record.why = query.text(3).value_or("");
  record.etag = query.text(4).value_or("");
  record.last_modified = query.text(5).value_or("");
  record.stored_unix_s = query.integer(6).value_or(0);
  record.expires_unix_s = query.integer(7);
  found.used = query.integer(8);
  // A tile stored by another program has no side row.
  record.pinned = found.row && query.integer(6) && !found.used;
  return found;
}

}  // namespace

Result<std::optional<FoundRecord>> CacheReaders::find(const TileId& id, bool bytes) {
  const auto failed = [&](const SqlError& error) {
    return Error{fmt::format("{}: the cache cannot be read: {}", path_.string(), error.message)};
  };
  Result<Connection, SqlError> connection = take();
  if (!connection) return failed(connection.error());
  SqliteQuery& query = bytes ? connection->whole : connection->brief;
  query.bind(1, id.level);
  query.bind(2, id.x);
  query.bind(3, id.y);
  const Result<bool, SqlError> row = query.step();
  std::optional<FoundRecord> found;
  if (row && *row) found = record_of(query);
  query.reset();
  give_back(*std::move(connection));
  if (!row) return failed(row.error());
  return found;
}

Result<std::vector<std::pair<std::int64_t, FoundRecord>>> CacheReaders::find_column(int level, std::int64_t x,
                                                                                    std::int64_t first_y,
                                                                                    std::int64_t last_y) {
  const auto failed = [&](const SqlError& error) {
    return Error{fmt::format("{}: the cache cannot be read: {}", path_.string(), error.message)};
  };
  Result<Connection, SqlError> connection = take();
  if (!connection) return failed(connection.error());
  SqliteQuery& query = connection->column;
  query.bind(1, level);
  query.bind(2, x);
  query.bind(3, first_y);
  query.bind(4, last_y);
  constexpr int kRowColumn = 9;
  std::vector<std::pair<std::int64_t, FoundRecord>> found;
  Result<bool, SqlError> row = query.step();
  for (; row && *row; row = query.step()) found.emplace_back(query.integer(kRowColumn).value_or(0), record_of(query));
  query.reset();
  give_back(*std::move(connection));
  if (!row) return failed(row.error());
  return found;
}

Result<CacheReaders::Connection, SqlError> CacheReaders::take() {
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
  Result<SqliteQuery, SqlError> whole = reader->prepare(find_sql("t.tile_data"));
  if (!whole) return whole.error();
  Result<SqliteQuery, SqlError> brief = reader->prepare(find_sql("NULL"));
  if (!brief) return brief.error();
  Result<SqliteQuery, SqlError> column = reader->prepare(kColumnSql);
  if (!column) return column.error();
  return Connection{*std::move(reader), *std::move(whole), *std::move(brief), *std::move(column)};
}

void CacheReaders::give_back(Connection connection) {
  const std::lock_guard lock(mutex_);
  idle_.push_back(std::move(connection));
}

void CacheReaders::close() {
  const std::lock_guard lock(mutex_);
  idle_.clear();
}

}  // namespace terrella
