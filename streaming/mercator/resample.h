#pragma once

#include <memory>
#include <vector>

#include "codecs/image.h"
#include "streaming/mercator/mercator_grid.h"

namespace terrella {

/// What stands for a piece of a plan: its own picture, or the part of an ancestor's that lies over it.
struct PiecePicture {
  std::shared_ptr<const Image> picture;  ///< nothing: transparent
  int steps = 0;                         ///< levels that it is coarser; bilinearly enlarged
  std::int64_t part_x = 0, part_y = 0;   ///< which of its 2^steps by 2^steps parts
};

/// Makes the picture of a tile: columns and rows summed as the plan says, colours weighed by alpha, in the values as
/// stored (as mips are). `pictures` in the plan's order of pieces, each tile_px a side. Where there is no piece, and
/// beyond the end of Web Mercator, it is transparent. 1 to 3 ms for 256 × 256 pixels. thread: any
[[nodiscard]] Image resample(const MercatorPlan& plan, const std::vector<PiecePicture>& pictures);

}  // namespace terrella
