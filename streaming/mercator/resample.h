#pragma once

#include <memory>
#include <vector>

#include "codecs/image.h"
#include "streaming/mercator/mercator_grid.h"

namespace terrella {

/// Picture for a piece of a plan: its own, or a part of an ancestor's picture.
struct PiecePicture {
  std::shared_ptr<const Image> picture;  ///< null: transparent
  int steps = 0;                         ///< number of levels coarser; enlarged bilinearly
  std::int64_t part_x = 0, part_y = 0;   ///< index among its 2^steps × 2^steps parts
};

/// Makes the picture of a tile. Sums columns and rows by the plan, with colours weighted by alpha, in stored values as
/// for mips. `pictures` are in the plan's order of pieces, tile_px a side. Places without a piece, or beyond the end of
/// Web Mercator, are transparent. Takes 1 to 3 ms for 256 × 256 pixels. thread: any
[[nodiscard]] Image resample(const MercatorPlan& plan, const std::vector<PiecePicture>& pictures);

}  // namespace terrella
