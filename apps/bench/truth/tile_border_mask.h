#pragma once

#include <cstdint>
#include <vector>

#include "apps/bench/truth/judge.h"
#include "apps/bench/truth/ray_caster.h"

namespace terrella::truth {

/// One byte a pixel, 0 or 1.
struct Mask {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> set;
};

/// Extends a mask by `reach_px` along rows and columns (a square).
[[nodiscard]] Mask grown(const Mask& mask, int reach_px);

/// Marks pixels that have a different tile among their eight neighbours; a border passes within a pixel of their
/// centre. Pixels whose centre misses the body are never set and never count as neighbours.
[[nodiscard]] Mask tile_border_mask(const TruthImage& truth, const Spheroid& body, const RowRule& rows,
                                    const TileBorders& borders);

}  // namespace terrella::truth
