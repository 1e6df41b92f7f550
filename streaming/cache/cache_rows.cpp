#include "streaming/cache/cache_rows.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "streaming/cache/cache_schema.h"

namespace terrella {
namespace {

// clang-format off
/// Indexed by CacheRows::Which.
constexpr std::array kSql = {
    "INSERT OR IGNORE INTO tiles (zoom_level, tile_column, tile_row, tile_data) VALUES (?1, ?2, ?3, ?4)",
    "SELECT id FROM tiles WHERE zoom_level = ?1 AND tile_column = ?2 AND tile_row = ?3",
    "UPDATE tiles SET tile_data = ?2 WHERE id = ?1",
    "INSERT INTO terrella_cache_tiles VALUES (?1, ?2, ?3, ?4, ?5, ?6) ON CONFLICT (id) DO UPDATE SET "
    "etag = excluded.etag, last_modified = excluded.last_modified, stored = excluded.stored, expires = excluded.expires, "
    "used = CASE WHEN used IS NULL THEN NULL ELSE excluded.used END",
    "DELETE FROM terrella_cache_absences WHERE zoom_level = ?1 AND tile_column = ?2 AND tile_row = ?3",
    "INSERT OR REPLACE INTO terrella_cache_absences VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9)",
    "DELETE FROM tiles WHERE id = ?1",
    "DELETE FROM terrella_cache_tiles WHERE id = ?1",
    "UPDATE terrella_cache_tiles SET stored = ?2, expires = ?3 WHERE id = ?1",
    "UPDATE terrella_cache_tiles SET expires = ?2 WHERE id = ?1",
    "UPDATE terrella_cache_absences SET stored = ?4, expires = ?5 "
    "WHERE zoom_level = ?1 AND tile_column = ?2 AND tile_row = ?3",
    "UPDATE terrella_cache_tiles SET used = ?2 WHERE id = ?1 AND used < ?2",
    "SELECT id, used FROM terrella_cache_tiles WHERE used IS NOT NULL ORDER BY used LIMIT ?1",
    "DELETE FROM terrella_cache_absences WHERE (zoom_level, tile_column, tile_row) IN "
    "(SELECT zoom_level, tile_column, tile_row FROM terrella_cache_absences WHERE stored <= ?1 ORDER BY stored LIMIT ?2)",
    "SELECT s.stored, 0 FROM tiles t LEFT JOIN terrella_cache_tiles s ON s.id = t.id "
    "WHERE zoom_level = ?1 AND tile_column = ?2 AND tile_row = ?3",
    "SELECT stored, kind = 'failed' FROM terrella_cache_absences WHERE zoom_level = ?1 AND tile_column = ?2 AND tile_row = ?3",
    "SELECT EXISTS (SELECT 1 FROM terrella_cache_tiles WHERE used IS NOT NULL)",
    "UPDATE terrella_cache_tiles SET used = NULL WHERE used IS NOT NULL AND id IN "
    "(SELECT id FROM tiles WHERE zoom_level = ?1 AND tile_column = ?2 AND tile_row BETWEEN ?3 AND ?4)",
    "UPDATE terrella_cache_tiles SET used = stored WHERE used IS NULL AND id IN "
    "(SELECT id FROM tiles WHERE zoom_level = ?1 AND tile_column = ?2 AND tile_row BETWEEN ?3 AND ?4)",
    "SELECT length(tile_data) FROM tiles WHERE zoom_level = ?1 AND tile_column = ?2 AND tile_row = ?3",
};
// clang-format on

/// Missing-tile records are small and are deleted in larger steps than tiles.
constexpr int kMissingPerTile = 16;

void bind_place(SqliteStatement& statement, const TileId& id) {
  statement.bind(1, std::int64_t{id.level});
  statement.bind(2, id.x);
  statement.bind(3, id.y);
}

}  // namespace

WriteResult<CacheRows> CacheRows::prepare(SqliteWriter& database, int root_level) {
  static_assert(kSql.size() == kCount);
  CacheRows rows(database, root_level);
  if (WriteStatus prepared = rows.prepare_all(); !prepared) return prepared.error();
  return rows;
}

WriteStatus CacheRows::prepare_all() {
  for (const char* sql : kSql) {
    WriteResult<SqliteStatement> statement = database_->prepare(sql);
    if (!statement) return statement.error();
    statements_.push_back(*std::move(statement));
  }
  return Done{};
}

WriteStatus CacheRows::put(const TileId& id, const CacheRecord& record, std::int64_t used_unix_s) {
  return record.missing ? put_missing(id, record) : put_tile(id, record, used_unix_s);
}

WriteStatus CacheRows::put_tile(const TileId& id, const CacheRecord& record, std::int64_t used_unix_s) {
  SqliteStatement& insert = statements_[kInsertTile];
  bind_place(insert, id);
  insert.bind(4, std::span(record.bytes));
  if (WriteStatus done = insert.run(); !done) return done;
  std::int64_t row = database_->last_row_id();
  if (database_->changed_rows() == 0) {
    const auto there = row_of(id);
    if (!there) return there.error();
    row = there->value_or(0);
    SqliteStatement& update = statements_[kUpdateTile];
    update.bind(1, row);
    update.bind(2, std::span(record.bytes));
    if (WriteStatus done = update.run(); !done) return done;
  }
  SqliteStatement& side = statements_[kPutSide];
  side.bind(1, row);
  side.bind(2, std::string_view(record.etag));
  side.bind(3, std::string_view(record.last_modified));
  side.bind(4, record.stored_unix_s);
  side.bind(5, record.expires_unix_s);
  const bool pinned = record.pinned || id.level == root_level_;
  side.bind(6, pinned ? std::nullopt : std::optional(used_unix_s));
  if (WriteStatus done = side.run(); !done) return done;
  bind_place(statements_[kDropMissing], id);
  return statements_[kDropMissing].run();
}

WriteStatus CacheRows::put_missing(const TileId& id, const CacheRecord& record) {
  const auto there = row_of(id);
  if (!there) return there.error();
  // A stored tile is kept: one answer of a server is no reason to lose it. The tile is requested again after the
  // record's lifetime. A failed request gives no information.
  if (*there)
    return *record.missing == MissingKind::failed ? WriteStatus(Done{}) : expire(**there, record.expires_unix_s);
  SqliteStatement& put = statements_[kPutMissing];
  bind_place(put, id);
  put.bind(4, std::string_view(missing_name(*record.missing)));
  put.bind(5, std::string_view(record.why));
  put.bind(6, std::string_view(record.etag));
  put.bind(7, std::string_view(record.last_modified));
  put.bind(8, record.stored_unix_s);
  put.bind(9, record.expires_unix_s);
  return put.run();
}

WriteStatus CacheRows::expire(std::int64_t row, std::optional<std::int64_t> expires_unix_s) {
  statements_[kExpireTile].bind(1, row);
  statements_[kExpireTile].bind(2, expires_unix_s);
  return statements_[kExpireTile].run();
}

WriteResult<std::int64_t> CacheRows::pin(const TileId& first, const PinRun& run) {
  if (!run.pinned && first.level == root_level_) return std::int64_t{0};
  if (run.pinned) {
    // In a resumed preload all tiles are pinned already.
    const WriteResult<std::int64_t> unpinned = number(kAnyUnpinned);
    if (!unpinned || *unpinned == 0) return unpinned;
  }
  SqliteStatement& pinning = statements_[run.pinned ? kPin : kRelease];
  bind_place(pinning, first);
  pinning.bind(4, run.last_y);
  if (WriteStatus done = pinning.run(); !done) return done.error();
  return database_->changed_rows();
}

WriteResult<std::int64_t> CacheRows::tile_bytes(const TileId& id) {
  bind_place(statements_[kTileBytes], id);
  return number(kTileBytes);
}

WriteResult<std::int64_t> CacheRows::number(Which which) {
  SqliteStatement& statement = statements_[which];
  const WriteResult<bool> row = statement.step();
  const std::int64_t value = row && *row ? statement.integer(0) : 0;
  statement.reset();
  if (!row) return row.error();
  return value;
}

WriteStatus CacheRows::renew(const TileId& id, std::int64_t stored_unix_s, std::optional<std::int64_t> expires) {
  const auto there = row_of(id);
  if (!there) return there.error();
  SqliteStatement& renewal = statements_[*there ? kRenewTile : kRenewMissing];
  const int first = *there ? 2 : 4;
  if (*there) {
    renewal.bind(1, **there);
  } else {
    bind_place(renewal, id);
  }
  renewal.bind(first, stored_unix_s);
  renewal.bind(first + 1, expires);
  return renewal.run();
}

WriteStatus CacheRows::note_use(std::int64_t row, std::int64_t used_unix_s) {
  statements_[kNoteUse].bind(1, row);
  statements_[kNoteUse].bind(2, used_unix_s);
  return statements_[kNoteUse].run();
}

WriteResult<std::int64_t> CacheRows::evict(int most) {
  SqliteStatement& oldest = statements_[kOldest];
  oldest.bind(1, std::int64_t{most});
  std::vector<std::int64_t> rows;
  std::int64_t until = std::numeric_limits<std::int64_t>::min();
  WriteResult<bool> more = oldest.step();
  for (; more && *more; more = oldest.step()) {
    rows.push_back(oldest.integer(0));
    until = std::max(until, oldest.integer(1));
  }
  oldest.reset();
  if (!more) return more.error();
  for (const std::int64_t row : rows) {
    if (WriteStatus deleted = delete_tile(row); !deleted) return deleted.error();
  }
  // Without tiles to evict, missing-tile records are evicted alone.
  if (rows.empty()) until = std::numeric_limits<std::int64_t>::max();
  statements_[kDropOldMissing].bind(1, until);
  statements_[kDropOldMissing].bind(2, std::int64_t{most} * kMissingPerTile);
  if (WriteStatus dropped = statements_[kDropOldMissing].run(); !dropped) return dropped.error();
  return static_cast<std::int64_t>(rows.size()) + (database_->changed_rows() > 0 ? 1 : 0);
}

WriteResult<CacheRows::Known> CacheRows::known(const TileId& id) {
  Known known;
  const std::pair<Which, std::optional<std::int64_t>*> looks[] = {{kTileStored, &known.tile_stored},
                                                                  {kMissingStored, &known.missing_stored}};
  for (const auto& [which, stored] : looks) {
    SqliteStatement& look = statements_[which];
    bind_place(look, id);
    const WriteResult<bool> row = look.step();
    if (row && *row) {
      *stored = look.integer(0);
      known.failed = look.integer(1) != 0;
    }
    look.reset();
    if (!row) return row.error();
  }
  return known;
}

WriteStatus CacheRows::delete_tile(std::int64_t row) {
  statements_[kDropTile].bind(1, row);
  if (WriteStatus done = statements_[kDropTile].run(); !done) return done;
  statements_[kDropSide].bind(1, row);
  return statements_[kDropSide].run();
}

WriteResult<std::optional<std::int64_t>> CacheRows::row_of(const TileId& id) {
  SqliteStatement& find = statements_[kFindTile];
  bind_place(find, id);
  const WriteResult<bool> row = find.step();
  std::optional<std::int64_t> found;
  if (row && *row) found = find.integer(0);
  find.reset();
  if (!row) return row.error();
  return found;
}

}  // namespace terrella
