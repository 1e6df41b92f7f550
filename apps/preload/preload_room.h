#pragma once

#include <cstdint>
#include <optional>

#include "apps/preload/preload_options.h"
#include "base/result.h"
#include "streaming/preload/sample_size.h"
#include "streaming/preload/tile_plan.h"

namespace terrella {

/// What a plan asks of a cache that has a limit. Nothing of a plan is ever evicted, so all of it must fit, beside what
/// was pinned before.
struct RoomNeed {
  std::int64_t tiles = 0;     ///< of the plan, that are not pinned in the cache yet; absences are not counted
  double pinned_bytes = 0.0;  ///< of the file, that tiles take which are pinned already
};

/// `settled`: WantedTiles::settled() of the whole plan. Reads the cache's file if there is one. thread: any
[[nodiscard]] RoomNeed room_need(const PreloadCommand& command, const TilePlan& plan, std::int64_t settled);

/// True if the plan fits even with the largest tiles that are likely: then no sample need be taken.
[[nodiscard]] bool surely_fits(const PreloadCommand& command, const RoomNeed& need, int tile_px);

/// Why the plan does not fit into the limit, by the mean size of a sample, and what to do. Nothing: it fits, there is
/// no limit, or the sample had no answer.
[[nodiscard]] std::optional<Error> find_no_room(const PreloadCommand& command, const TilePlan& plan,
                                                const RoomNeed& need, const SizeSample& sample);

}  // namespace terrella
