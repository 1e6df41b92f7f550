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

/// What the cache knows of a tile: its bytes, or why there are none (engine/DESIGN.md, 11), and what HTTP needs to ask
/// again.
struct CacheRecord {
  std::optional<Absence> absence;  ///< none: `bytes` is the tile
  std::vector<std::byte> bytes;
  std::string why;  ///< of an absence
  std::string etag;
  std::string last_modified;
  std::int64_t stored_unix_s = 0;
  std::optional<std::int64_t> expires_unix_s;  ///< none: does not expire
  bool pinned = false;                         ///< a tile that is never evicted: of the coarsest level, or preloaded
};
[[nodiscard]] inline bool is_fresh(const CacheRecord& record, std::int64_t now_unix_s) {
  return !record.expires_unix_s || *record.expires_unix_s > now_unix_s;
}

/// Why a cache cannot be opened.
struct CacheOpenError : Error {
  bool cannot_write = false;  ///< its place is at fault (rights, space, a lock), not what is in the file
};

/// Why a record is not in the file.
struct StoreError : Error {
  bool no_room = false;  ///< the limit is reached, and nothing that could be evicted is left; the file is sound
};
using StoreStatus = Result<Done, StoreError>;

struct CacheOptions {
  /// Of the file; 0: none. The least recently used tiles that are not pinned go first and the space is given back. If
  /// only pinned tiles are left, new tiles are not kept.
  std::uint64_t max_bytes = 0;
  /// Called once for each wait of more than a second for a lock that another program holds, on opening by the caller's
  /// thread, later by the writer's. At most a minute is waited.
  std::function<void()> on_locked{};
  std::size_t batch_tiles = 256;              ///< written in one transaction at most
  std::size_t max_queued_bytes = 64UL << 20;  ///< store() waits over this
};

struct CacheCounts {
  std::uint64_t file_bytes = 0;
  std::uint64_t stored = 0;  ///< records made durable since opening
  std::uint64_t evicted = 0;
  std::uint64_t pins_changed = 0;  ///< tiles that pin() pinned or released since opening
  bool locked = false;  ///< the writer has waited for more than a second for a lock that another program holds
};

/// One source's tiles in a GeoPackage that GDAL and QGIS open while it is in use (engine/DESIGN.md, 8): tiles as in any
/// GeoPackage, absences, validators, expiry and last use in side tables. Several processes may use one file. All
/// writing is done by one thread, in batches; root tiles (level grid.min_level) and pinned tiles are never evicted.
class TileCache {
 public:
  /// Opens the cache or makes it. A file that holds another source's tiles (another grid, another `source_key`) is
  /// refused by name. One that is damaged is renamed NAME.damaged-N, a fresh one begun, and `set_aside()` says so.
  /// thread: any
  [[nodiscard]] static Result<std::shared_ptr<TileCache>, CacheOpenError> open(const std::filesystem::path& path,
                                                                               const TileSetInfo& info,
                                                                               const std::string& source_key,
                                                                               const CacheOptions& options = {});
  virtual ~TileCache() = default;  ///< writes what is queued

  [[nodiscard]] virtual const TileSetInfo& info() const = 0;
  /// The damaged file that was set aside on opening; empty: none.
  [[nodiscard]] virtual std::filesystem::path set_aside() const = 0;

  /// What is known, what is queued for writing included; notes the use. thread: any, several at once
  [[nodiscard]] virtual Result<std::optional<CacheRecord>> find(const TileId& id) = 0;
  /// The same without the bytes and without noting a use. thread: any, several at once
  [[nodiscard]] virtual Result<std::optional<CacheRecord>> peek(const TileId& id) = 0;
  /// peek() for tiles below one another: calls for each row in [first_y, last_y] of which anything is known, from the
  /// north, records without bytes. One look for all of them where the cache can. thread: any, several at once
  [[nodiscard]] virtual Status peek_column(int level, std::int64_t x, std::int64_t first_y, std::int64_t last_y,
                                           const std::function<void(std::int64_t y, const CacheRecord& record)>& call) {
    for (std::int64_t y = first_y; y <= last_y; ++y) {
      const auto record = peek({level, x, y});
      if (!record) return record.error();
      if (*record) call(y, **record);
    }
    return Done{};
  }
  /// Queues a record to be written in the place of what is known; but an absence never takes the place of a tile: the
  /// tile then expires when the absence would (`failed` changes nothing). `on_durable` is called on the writer's thread
  /// once it would survive kill -9, or with the reason why it could not be written (disk full, no room under the
  /// limit); later records are still tried. thread: any
  virtual void store(const TileId& id, CacheRecord record, std::function<void(const StoreStatus&)> on_durable = {}) = 0;
  /// Notes that a tile was found unchanged (304): new expiry, same bytes. thread: any
  virtual void renew(const TileId& id, std::int64_t stored_unix_s, std::optional<std::int64_t> expires_unix_s,
                     std::function<void(const StoreStatus&)> on_durable = {}) = 0;
  /// Queues the pinning, or the release, of the tiles that are there from `first` down to the row `last_y`. Tiles of
  /// the coarsest level stay pinned. thread: any
  virtual void pin(const TileId& first, std::int64_t last_y, bool pinned) = 0;
  /// Waits until all that is queued is durable. The first error since the last flush, if any. thread: any but the
  /// writer
  [[nodiscard]] virtual Status flush() = 0;
  [[nodiscard]] virtual CacheCounts counts() const = 0;  ///< thread: any
};

}  // namespace terrella
