#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "tiles/tile_source.h"

namespace terrella {

/// A cached tile: its bytes, or the reason why there are none (engine/DESIGN.md, 11), and the validators for a
/// conditional request.
struct CacheRecord {
  std::optional<MissingKind> missing;  ///< none: `bytes` is the tile
  std::vector<std::byte> bytes;
  std::string why;  ///< the reason why the tile is missing
  std::string etag;
  std::string last_modified;
  std::int64_t stored_unix_s = 0;
  std::optional<std::int64_t> expires_unix_s;  ///< none: does not expire
  bool pinned = false;                         ///< never evicted: a tile of the coarsest level, or a preloaded tile
};
[[nodiscard]] inline bool is_fresh(const CacheRecord& record, std::int64_t now_unix_s) {
  return !record.expires_unix_s || *record.expires_unix_s > now_unix_s;
}

/// Reason why a cache cannot be opened.
struct CacheOpenError : Error {
  bool cannot_write = false;  ///< the location is at fault (rights, space, a lock), not the content of the file
};

/// Reason why a record was not written.
struct StoreError : Error {
  bool no_room = false;  ///< the limit is reached and nothing more can be evicted; the file is sound
};
using StoreStatus = Result<Done, StoreError>;

struct CacheOptions {
  /// Limit of the file size; 0: no limit. The least recently used unpinned tiles are evicted and their space is given
  /// back. If only pinned tiles are left, new tiles are not kept.
  std::uint64_t max_bytes = 0;
  /// Called once for each wait of more than a second for another program's lock: on the caller's thread during opening,
  /// later on the writer's thread. No wait is longer than a minute.
  std::function<void()> on_locked{};
  /// Called once, when records cannot be written for the first time: disk full, the file removed or damaged by another
  /// program. thread: the writer
  std::function<void(const Error&)> on_failed{};
  std::size_t batch_tiles = 256;              ///< most tiles in one transaction; 0 counts as 1
  std::size_t max_queued_bytes = 64UL << 20;  ///< store() blocks while more is queued
};

struct CacheCounts {
  std::uint64_t file_bytes = 0;
  std::uint64_t stored = 0;  ///< durable records since opening
  std::uint64_t evicted = 0;
  std::uint64_t pins_changed = 0;  ///< tiles that pin() pinned or released since opening
  bool locked = false;             ///< the writer has waited for more than a second for another program's lock
};

/// Cache of one source's tiles in a GeoPackage. GDAL and QGIS can open the file while it is in use (engine/DESIGN.md,
/// 8). Tiles are stored as in any GeoPackage; missing-tile records, validators, expiry and last use are in side tables.
/// Several processes may share a file. One thread does all writing, in batches. Root tiles (level grid.min_level) and
/// pinned tiles are never evicted.
class TileCache {
 public:
  /// Opens or creates a cache. A file of another source (another grid or another `source_key`) is refused by name. A
  /// damaged file is renamed NAME.damaged-N and replaced by a new file; `set_aside()` returns the new name. thread: any
  [[nodiscard]] static Result<std::shared_ptr<TileCache>, CacheOpenError> open(const std::filesystem::path& path,
                                                                               const TileSetInfo& info,
                                                                               const std::string& source_key,
                                                                               const CacheOptions& options = {});
  virtual ~TileCache() = default;  ///< writes all queued records

  [[nodiscard]] virtual const TileSetInfo& info() const = 0;
  /// Path of the damaged file that was set aside on opening; empty: none.
  [[nodiscard]] virtual std::filesystem::path set_aside() const = 0;

  /// Returns the record of a tile, from the file or the write queue, and notes its use. thread: any, several at once
  [[nodiscard]] virtual Result<std::optional<CacheRecord>> find(const TileId& id) = 0;
  /// Like find(), but without the tile's bytes, and without noting a use. thread: any, several at once
  [[nodiscard]] virtual Result<std::optional<CacheRecord>> peek(const TileId& id) = 0;
  /// Like peek() for the rows [first_y, last_y] of a column. Calls `call` for each row that has a record, from the
  /// north, without bytes. Uses a single lookup if the cache supports it. thread: any, several at once
  [[nodiscard]] virtual Status peek_column(int level, std::int64_t x, std::int64_t first_y, std::int64_t last_y,
                                           const std::function<void(std::int64_t y, const CacheRecord& record)>& call) {
    for (std::int64_t y = first_y; y <= last_y; ++y) {
      const auto record = peek({level, x, y});
      if (!record) return record.error();
      if (*record) call(y, **record);
    }
    return Done{};
  }
  /// Queues a record, which replaces the present record. A missing-tile record never replaces a tile: the tile then
  /// takes the record's expiry (`failed` changes nothing). `on_durable` is called on the writer's thread when the
  /// record would survive kill -9. If the record cannot be written (disk full, no room under the limit), `on_durable`
  /// gets the reason. After a failure later records are still tried. thread: any
  virtual void store(const TileId& id, CacheRecord record, std::function<void(const StoreStatus&)> on_durable = {}) = 0;
  /// Records that a tile was found unchanged (304): new expiry, same bytes. thread: any
  virtual void renew(const TileId& id, std::int64_t stored_unix_s, std::optional<std::int64_t> expires_unix_s,
                     std::function<void(const StoreStatus&)> on_durable = {}) = 0;
  /// Queues the pinning or release of the stored tiles from `first` down to row `last_y`. Tiles of the coarsest level
  /// stay pinned. thread: any
  virtual void pin(const TileId& first, std::int64_t last_y, bool pinned) = 0;
  /// Blocks until all queued records are durable, and checks that the file is still there under its name. Returns the
  /// first error since the last flush, if any.
  /// thread: any but the writer
  [[nodiscard]] virtual Status flush() = 0;
  [[nodiscard]] virtual CacheCounts counts() const = 0;  ///< thread: any
};

}  // namespace terrella
