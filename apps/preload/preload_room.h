#pragma once

#include <cstdint>
#include <optional>

#include "apps/preload/preload_options.h"
#include "base/result.h"
#include "streaming/preload/sample_size.h"
#include "streaming/preload/tile_plan.h"

namespace terrella {

/// Space that a plan needs in a cache with a size limit. Planned tiles are never evicted, so all of them must fit
/// beside the tiles pinned earlier.
struct RoomNeed {
  std::int64_t tiles = 0;     ///< planned tiles not yet pinned in the cache, without missing tiles
  double pinned_bytes = 0.0;  ///< bytes of the file used by pinned tiles
};

/// Computes the space that a plan needs. `settled` is WantedTiles::settled() for the whole plan. Reads the cache's file
/// if the file exists. thread: any
[[nodiscard]] RoomNeed room_need(const PreloadCommand& command, const TilePlan& plan, std::int64_t settled);

/// True if the plan fits even with the largest likely tiles; then no sample is needed.
[[nodiscard]] bool surely_fits(const PreloadCommand& command, const RoomNeed& need, int tile_px);

/// Explains why the plan exceeds the limit, by the mean size of a sample, and what to do. Returns nullopt if the plan
/// fits, without a limit, or if the sample got no answer.
[[nodiscard]] std::optional<Error> find_no_room(const PreloadCommand& command, const TilePlan& plan,
                                                const RoomNeed& need, const SizeSample& sample);

}  // namespace terrella
