#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "base/result.h"
#include "streaming/cache/tile_cache.h"
#include "streaming/preload/tile_origin.h"
#include "streaming/preload/tile_plan.h"

namespace terrella {

/// Why a tile that was asked for is not in the cache afterwards.
enum class Lack {
  broken,   ///< what came is no picture of the set's size, or a picture cut off
  refused,  ///< the server will not give it: 401, 403, redirects without end, too large, not to be stored
  failed,   ///< no answer after all attempts, twice
  no_room,  ///< the cache's limit is reached by tiles that may not be evicted
};

/// How far a preload is.
struct PreloadCounts {
  std::int64_t planned = 0;
  std::int64_t passed = 0;     ///< of those, looked at: there already, or ended in one of what follows
  std::int64_t there = 0;      ///< known and fresh in the cache: not asked for
  std::int64_t stored = 0;     ///< written, and would survive kill -9
  std::int64_t unchanged = 0;  ///< asked for conditionally, not changed, noted so
  std::int64_t absent = 0;     ///< the source has no such tile (404, 204, 410): noted in the cache
  std::int64_t blank = 0;      ///< it has one without content: noted in the cache
  std::int64_t kept = 0;       ///< the source no longer has it; the tile that was stored before stays
  std::int64_t broken = 0, refused = 0, failed = 0, no_room = 0;  ///< see Lack
  std::uint64_t stored_bytes = 0;
  HttpCounts asked;
  bool locked = false;  ///< another program holds the cache's file, and nothing can be written for now
  [[nodiscard]] std::int64_t lacking() const { return broken + refused + failed + no_room; }
};

struct PreloadOptions {
  std::size_t window = 384;  ///< questions under way at most, [1, 1e5]
  int tile_px = 256;
  std::optional<std::chrono::seconds> refresh_older_than{};  ///< none: what has expired is asked for again
  std::chrono::seconds tile_life{7 * 24 * 3600};             ///< where the server says nothing
  std::chrono::seconds absence_life{24 * 3600};              ///< likewise
  bool expires = true;                      ///< false: what is stored without a time to expire stays (sets on disk)
  std::size_t most_second_tries = 1000000;  ///< failures beyond these are not tried a second time
  int give_up_after = 512;                  ///< failures in a row after which the source is taken to be down
  std::chrono::milliseconds finish_within{5000};  ///< for what is in flight once told to stop

  /// Called about ten times a second, and at the end; false: stop. thread: the one that runs
  std::function<bool(const PreloadCounts&)> progress{};
  /// A tile that would survive kill -9. thread: the cache's writer
  std::function<void(const TileId&)> on_stored;
  /// A tile that is finally lacking, and why. thread: the one that runs
  std::function<void(const TileId&, Lack, const std::string& why)> on_lacking;
};

enum class PreloadEnd {
  complete,     ///< every planned tile was looked at
  stopped,      ///< progress() said so
  source_down,  ///< too many failures in a row
};
struct PreloadResult {
  PreloadEnd end = PreloadEnd::complete;
  PreloadCounts counts;
};

/// Pins the tiles of a plan that a cache has, or releases them, and waits until that is written. Returns how many
/// changed. thread: any but the cache's writer
[[nodiscard]] Result<std::int64_t> pin_planned(const TilePlan& plan, TileCache& cache, bool pinned);

/// Brings what a plan names into a cache: passes over what is there and fresh without a request, asks for the rest,
/// with validators where there is something, checks what comes and stores it; at the end asks once more for what
/// failed. What is lacking is not noted in the cache, so that the next run asks for it again, and never takes the place
/// of an older tile. All tiles of the plan are pinned: nothing evicts them. Once the cache has no room for a tile,
/// tiles that it does not have are not asked for any more: they are lacking too. `make_origin` gets the queue that
/// takes the answers. Fails only if the cache cannot be read or written (disk full); what was stored before stays.
/// Blocks. thread: any but the cache's writer
[[nodiscard]] Result<PreloadResult> preload(const TilePlan& plan, TileCache& cache,
                                            const std::function<std::unique_ptr<TileOrigin>(ReplyQueue&)>& make_origin,
                                            const PreloadOptions& options);

}  // namespace terrella
