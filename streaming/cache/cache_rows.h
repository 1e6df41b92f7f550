#pragma once

#include <cstdint>
#include <optional>

#include "streaming/cache/sqlite_writer.h"
#include "streaming/cache/tile_cache.h"
#include "streaming/cache/write_queue.h"

namespace terrella {

/// The statements that change a cache's rows. Transactions are the caller's. thread: the connection's
class CacheRows {
 public:
  /// Tiles of `root_level` are pinned: they get no last use, so that they are never evicted.
  [[nodiscard]] static WriteResult<CacheRows> prepare(SqliteWriter& database, int root_level);

  /// Puts a record in the place of what was known of the tile; but an absence never takes the place of a tile: then it
  /// only says when the tile expires (`failed` not even that). A tile that was pinned stays pinned.
  [[nodiscard]] WriteStatus put(const TileId& id, const CacheRecord& record, std::int64_t used_unix_s);
  [[nodiscard]] WriteStatus renew(const TileId& id, std::int64_t stored_unix_s, std::optional<std::int64_t> expires);
  /// Pins or releases the tiles of a run. Returns how many changed.
  [[nodiscard]] WriteResult<std::int64_t> pin(const TileId& first, const PinRun& run);
  /// The size of a tile that is there, else 0.
  [[nodiscard]] WriteResult<std::int64_t> tile_bytes(const TileId& id);
  /// `row` is the tile's id in the table; a later use that is there stays.
  [[nodiscard]] WriteStatus note_use(std::int64_t row, std::int64_t used_unix_s);
  /// Deletes up to `most` tiles that are not pinned and were used longest ago, and absences that are as old. Returns
  /// how many rows.
  [[nodiscard]] WriteResult<std::int64_t> evict(int most);

  /// What is known of a place: when it was stored.
  struct Known {
    std::optional<std::int64_t> tile_stored;
    std::optional<std::int64_t> absence_stored;
    bool failed = false;  ///< the absence is of that kind
  };
  [[nodiscard]] WriteResult<Known> known(const TileId& id);

 private:
  CacheRows(SqliteWriter& database, int root_level) : database_(&database), root_level_(root_level) {}
  [[nodiscard]] WriteStatus prepare_all();
  [[nodiscard]] WriteStatus put_tile(const TileId& id, const CacheRecord& record, std::int64_t used_unix_s);
  [[nodiscard]] WriteStatus put_absence(const TileId& id, const CacheRecord& record);
  [[nodiscard]] WriteStatus delete_tile(std::int64_t row);
  [[nodiscard]] WriteStatus expire(std::int64_t row, std::optional<std::int64_t> expires_unix_s);
  [[nodiscard]] WriteResult<std::optional<std::int64_t>> row_of(const TileId& id);

  enum Which : std::size_t {
    kInsertTile,
    kFindTile,
    kUpdateTile,
    kPutSide,
    kDropAbsence,
    kPutAbsence,
    kDropTile,
    kDropSide,
    kRenewTile,
    kExpireTile,
    kRenewAbsence,
    kNoteUse,
    kOldest,
    kDropOldAbsences,
    kTileStored,
    kAbsenceStored,
    kAnyUnpinned,
    kPin,
    kRelease,
    kTileBytes,
    kCount
  };
  [[nodiscard]] WriteResult<std::int64_t> number(Which which);  ///< the first column of the first row, else 0

  SqliteWriter* database_;
  int root_level_;
  std::vector<SqliteStatement> statements_;  ///< by Which
};

}  // namespace terrella
