#pragma once

#include "streaming/warp/canvas.h"
#include "streaming/warp/warp_plan.h"

namespace terrella {

/// Makes a tile by its plan. `level` is the plan's. Places that the plan does not reach are transparent, or NaN.
/// Colours are weighted by alpha, in stored values as for mips; NaN takes no part. A source that lies on the tile's
/// pixels is copied. A failure is one of `block_at`. thread: any
[[nodiscard]] Result<Image, TileFailure> warp_picture(const WarpPlan& plan, const WarpLevel& level,
                                                      const BlockAt& block_at);
[[nodiscard]] Result<Numbers, TileFailure> warp_numbers(const WarpPlan& plan, const WarpLevel& level,
                                                        const BlockAt& block_at);

}  // namespace terrella
