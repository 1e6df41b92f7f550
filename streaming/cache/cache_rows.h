#pragma once

#include <cstdint>
#include <optional>

#include "streaming/cache/sqlite_writer.h"
#include "streaming/cache/tile_cache.h"
#include "streaming/cache/write_queue.h"

namespace terrella {

/// Prepared statements that change the rows of a cache. The caller begins and ends transactions.
/// thread: the connection's
class CacheRows {
 public:
  /// Tiles of `root_level` are pinned: they have no last use and are never evicted.
  [[nodiscard]] static WriteResult<CacheRows> prepare(SqliteWriter& database, int root_level);

  /// Replaces the record of a tile. A missing-tile record never replaces a stored tile: the tile then takes the
  /// missing-tile record's expiry
  /// (`failed` changes nothing). A pinned tile stays pinned.
  [[nodiscard]] WriteStatus put(const TileId& id, const CacheRecord& record, std::int64_t used_unix_s);
  [[nodiscard]] WriteStatus renew(const TileId& id, std::int64_t stored_unix_s, std::optional<std::int64_t> expires);
  /// Pins or releases the tiles of a run. Returns the number of changed tiles.
  [[nodiscard]] WriteResult<std::int64_t> pin(const TileId& first, const PinRun& run);
  /// Size of a stored tile; 0 if there is none.
  [[nodiscard]] WriteResult<std::int64_t> tile_bytes(const TileId& id);
  /// `row` is the tile's id in the table. A later use that is already stored is kept.
  [[nodiscard]] WriteStatus note_use(std::int64_t row, std::int64_t used_unix_s);
  /// Deletes up to `most` unpinned tiles, least recently used first, and missing-tile records of the same age. Returns
  /// the number of deleted rows.
  [[nodiscard]] WriteResult<std::int64_t> evict(int most);

  /// Storage times of a place.
  struct Known {
    std::optional<std::int64_t> tile_stored;
    std::optional<std::int64_t> missing_stored;
    bool failed = false;  ///< the missing-tile record is of kind `failed`
  };
  [[nodiscard]] WriteResult<Known> known(const TileId& id);

 private:
  CacheRows(SqliteWriter& database, int root_level) : database_(&database), root_level_(root_level) {}
  [[nodiscard]] WriteStatus prepare_all();
  [[nodiscard]] WriteStatus put_tile(const TileId& id, const CacheRecord& record, std::int64_t used_unix_s);
  [[nodiscard]] WriteStatus put_missing(const TileId& id, const CacheRecord& record);
  [[nodiscard]] WriteStatus delete_tile(std::int64_t row);
  [[nodiscard]] WriteStatus expire(std::int64_t row, std::optional<std::int64_t> expires_unix_s);
  [[nodiscard]] WriteResult<std::optional<std::int64_t>> row_of(const TileId& id);

  enum Which : std::size_t {
    kInsertTile,
    kFindTile,
    kUpdateTile,
    kPutSide,
    kDropMissing,
    kPutMissing,
    kDropTile,
    kDropSide,
    kRenewTile,
    kExpireTile,
    kRenewMissing,
    kNoteUse,
    kOldest,
    kDropOldMissing,
    kTileStored,
    kMissingStored,
    kAnyUnpinned,
    kPin,
    kRelease,
    kTileBytes,
    kCount
  };
  [[nodiscard]] WriteResult<std::int64_t> number(Which which);  ///< first column of the first row; 0 without a row

  SqliteWriter* database_;
  int root_level_;
  std::vector<SqliteStatement> statements_;  ///< indexed by Which
};

}  // namespace terrella
