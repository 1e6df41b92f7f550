#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "streaming/preload/tile_origin.h"
#include "streaming/preload/tile_plan.h"

namespace terrella {

/// Estimates for a plan from a few of its tiles.
struct SizeSample {
  int asked = 0;
  int answered = 0;               ///< tiles answered: content, or "no such tile"
  double bytes_per_tile = 0.0;    ///< mean over the plan; tiles that do not exist count as 0 bytes
  double seconds_per_tile = 0.0;  ///< from request to answer, one tile at a time
  std::string why;                ///< reason of the last failure
};

/// Asks for at most `most` tiles spread over the plan, one after the other. Finer levels, which have most of the tiles,
/// are asked more often. Stops at the first two tiles without an answer, or when `go_on` says so. Blocks. thread: any
[[nodiscard]] SizeSample sample_sizes(const TilePlan& plan, int most,
                                      const std::function<std::unique_ptr<TileOrigin>(ReplyQueue&)>& make_origin,
                                      const std::function<bool()>& go_on);

}  // namespace terrella
