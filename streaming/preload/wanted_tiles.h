#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "streaming/cache/tile_cache.h"
#include "streaming/preload/tile_plan.h"

namespace terrella {

/// A tile to request, and its state in the cache.
struct WantedTileRecord {
  TileId id;
  bool have = false;  ///< the cache has an outdated tile; `etag` and `last_modified` belong to it
  std::string etag;
  std::string last_modified;
};

/// Yields the tiles of a plan that are missing or outdated in a cache, in the plan's order. Looks up runs of tiles
/// instead of single tiles, so a resumed preload quickly reaches the point where it stopped. thread: one at a time
class WantedTiles {
 public:
  /// With `refresh_older_than`, tiles stored before that age are wanted whatever their expiry. Without, expired tiles
  /// are wanted.
  WantedTiles(const TilePlan& plan, TileCache& cache, std::optional<std::chrono::seconds> refresh_older_than);

  /// Searches for the next wanted tile. Returns nothing if all tiles were checked, or after a few thousand tiles that
  /// are not wanted; done() tells which.
  [[nodiscard]] Result<std::optional<WantedTileRecord>> next();
  [[nodiscard]] bool done() const { return done_ && at_ == found_.size(); }
  [[nodiscard]] std::int64_t there() const { return there_; }  ///< tiles not wanted so far
  /// Number of checked tiles that are pinned, or are fresh missing-tile records. They need no additional room.
  [[nodiscard]] std::int64_t settled() const { return settled_; }

 private:
  [[nodiscard]] Status look();
  [[nodiscard]] bool is_up_to_date(const CacheRecord& record) const;

  TileCache& cache_;
  std::unique_ptr<TileFeed> feed_;
  std::optional<std::chrono::seconds> refresh_older_than_;
  std::int64_t now_unix_s_ = 0;
  TileRun run_;  ///< rest of the run in progress
  std::vector<WantedTileRecord> found_;
  std::size_t at_ = 0;
  std::int64_t there_ = 0;
  std::int64_t settled_ = 0;
  bool done_ = false;
};

/// Seconds since 1970 by the system clock. thread: any
[[nodiscard]] std::int64_t unix_now_s();

}  // namespace terrella
