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

/// The mask and all within `reach_px` of it, counted along rows and columns (a square).
[[nodiscard]] Mask grown(const Mask& mask, int reach_px);

/// Pixels one of whose eight neighbours shows another tile: a border passes within a pixel of their centre. Pixels
/// whose centre misses the body are never set and are nobody's neighbour.
[[nodiscard]] Mask tile_border_mask(const TruthImage& truth, const Spheroid& body, const RowRule& rows,
                                    const TileBorders& borders);

}  // namespace terrella::truth
