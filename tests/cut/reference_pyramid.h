#pragma once

#include <array>
#include <cstdint>

#include "codecs/image.h"

namespace terrella::test {

/// Place of a picture in its grid, by the finest level's pixels.
struct Placement {
  std::int64_t x0 = 0;  ///< distance of its first column from -180°
  std::int64_t y0 = 0;  ///< distance of its first row from +90°
  double pixel_deg = 1.0;
  bool wraps = true;
  bool equal_area = false;
};

/// Colour that a pixel `steps` levels above the finest should hold, in double and straight from the picture: the mean
/// of all source pixels under it, each weighted by the area on the unit sphere between its two parallels, colours by
/// alpha too. Columns go round the planet if the picture does; rows beyond it have no part. (R, G, B, A), 0 to 255.
[[nodiscard]] std::array<double, 4> mean_under(const Image& picture, const Placement& placement, int steps,
                                               std::int64_t x, std::int64_t y);

}  // namespace terrella::test
