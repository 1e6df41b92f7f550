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

/// A tile to ask for, with what the cache knows of it.
struct WantedTileRecord {
  TileId id;
  bool have = false;  ///< there is a tile, out of date: `etag` and `last_modified` are its
  std::string etag;
  std::string last_modified;
};

/// The tiles of a plan that a cache lacks or has out of date, in the plan's order: looks at runs of tiles rather than
/// at each, so that a run that was broken off goes on at once where it stopped. thread: one at a time
class WantedTiles {
 public:
  /// `refresh_older_than`: what was stored before is wanted, whatever its expiry; none: what has expired.
  WantedTiles(const TilePlan& plan, TileCache& cache, std::optional<std::chrono::seconds> refresh_older_than);

  /// Looks on until something is wanted, all has been looked at, or a few thousand tiles were passed over: then
  /// nothing, and done() tells which.
  [[nodiscard]] Result<std::optional<WantedTileRecord>> next();
  [[nodiscard]] bool done() const { return done_ && at_ == found_.size(); }
  [[nodiscard]] std::int64_t there() const { return there_; }  ///< passed over so far
  /// Of all looked at so far: pinned tiles, and absences that are fresh. They need no more room than they have.
  [[nodiscard]] std::int64_t settled() const { return settled_; }

 private:
  [[nodiscard]] Status look();
  [[nodiscard]] bool is_up_to_date(const CacheRecord& record) const;

  TileCache& cache_;
  std::unique_ptr<TileFeed> feed_;
  std::optional<std::chrono::seconds> refresh_older_than_;
  std::int64_t now_unix_s_ = 0;
  TileRun run_;  ///< what is left of the run being looked at
  std::vector<WantedTileRecord> found_;
  std::size_t at_ = 0;
  std::int64_t there_ = 0;
  std::int64_t settled_ = 0;
  bool done_ = false;
};

/// Seconds since 1970 by the machine's clock. thread: any
[[nodiscard]] std::int64_t unix_now_s();

}  // namespace terrella
