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
#include "streaming/remote/remote_tile_set.h"

namespace terrella {

/// Reason why a requested tile is missing in the cache afterwards.
enum class PreloadMissing {
  broken,   ///< the answer is no picture of the set's size, or does not decode
  refused,  ///< the server refuses: 401, 403, endless redirects, too large, not to be stored
  failed,   ///< no answer in both rounds of attempts
  no_room,  ///< the cache is full of tiles that may not be evicted
};

/// Progress of a preload.
struct PreloadCounts {
  std::int64_t planned = 0;
  std::int64_t passed = 0;     ///< planned tiles done so far: already cached, or counted in a field below
  std::int64_t there = 0;      ///< cached and fresh: not requested
  std::int64_t stored = 0;     ///< written so that the tile would survive kill -9
  std::int64_t unchanged = 0;  ///< conditional request answered "not changed"; recorded in the cache
  std::int64_t absent = 0;     ///< the source has no such tile (404, 204, 410); recorded in the cache
  std::int64_t blank = 0;      ///< the tile has no content; recorded in the cache
  std::int64_t kept = 0;       ///< no longer in the source; the stored tile stays
  std::int64_t broken = 0, refused = 0, failed = 0, no_room = 0;  ///< see PreloadMissing
  std::uint64_t stored_bytes = 0;
  HttpCounts asked;
  std::chrono::seconds waits{0};  ///< until requests may be sent, if there are some to send; else 0
  bool locked = false;            ///< another program holds the cache file and blocks writing for now
  [[nodiscard]] std::int64_t missing() const { return broken + refused + failed + no_room; }
};

struct PreloadOptions {
  std::size_t window = 384;  ///< most requests in flight, [1, 1e5]
  RemoteTileSet set{};
  std::optional<std::chrono::seconds> refresh_older_than{};  ///< none: only expired tiles are requested again
  std::chrono::seconds tile_life{7 * 24 * 3600};             ///< used if the server gives no expiry
  std::chrono::seconds missing_life{24 * 3600};              ///< used if the server gives no expiry
  bool expires = true;                            ///< false: tiles without an expiry never expire (sets on disk)
  std::size_t most_second_tries = 1000000;        ///< failures beyond this number get no second try
  int give_up_after = 512;                        ///< consecutive failures after which the source counts as down
  std::chrono::milliseconds finish_within{5000};  ///< time for requests in flight after a stop

  /// Returns how long nothing may be requested from now on; 0: requests may be sent. Called often; none: always.
  /// Requests that are on their way come to their end meanwhile. thread: the caller of preload()
  std::function<std::chrono::seconds()> closed_for{};
  /// Called about ten times a second and at the end. Return false to stop. thread: the caller of preload()
  std::function<bool(const PreloadCounts&)> progress{};
  /// Called for each tile that would survive kill -9. thread: the cache's writer
  std::function<void(const TileId&)> on_stored;
  /// Called for each tile that is finally missing, with the reason. thread: the caller of preload()
  std::function<void(const TileId&, PreloadMissing, const std::string& why)> on_missing;
};

enum class PreloadEnd {
  complete,     ///< every planned tile was processed
  stopped,      ///< progress() returned false
  source_down,  ///< too many consecutive failures
};
struct PreloadResult {
  PreloadEnd end = PreloadEnd::complete;
  PreloadCounts counts;
};

/// Pins or releases the cached tiles of a plan, and waits until the change is written. Returns the number of changed
/// tiles. thread: any but the cache's writer
[[nodiscard]] Result<std::int64_t> pin_planned(const TilePlan& plan, TileCache& cache, bool pinned);

/// Brings the tiles of a plan into a cache. Fresh tiles are passed over without a request. The others are requested,
/// with validators if the cache has an outdated tile. Answers are checked and stored. At the end failed tiles are
/// requested once more. Tiles that stay missing (PreloadMissing) are not recorded, so that the next run requests them
/// again. They never replace an older tile. All tiles of the plan are pinned: nothing evicts them. Once the cache has
/// no room for a tile, tiles that it does not have are not requested any more and count as missing. `make_origin` gets
/// the queue that takes the answers. Fails only if the cache cannot be read or written: disk full, or the file was
/// removed or damaged by another program; the error says if tiles stored before are safe. Blocks. thread: any but the
/// cache's writer
[[nodiscard]] Result<PreloadResult> preload(const TilePlan& plan, TileCache& cache,
                                            const std::function<std::unique_ptr<TileOrigin>(ReplyQueue&)>& make_origin,
                                            const PreloadOptions& options);

}  // namespace terrella
