#pragma once

#include <vector>

namespace terrella {

/// A decoded raster of one number per pixel: rows from the top, no padding. NaN marks a pixel without data.
struct Numbers {
  int width_px = 0;
  int height_px = 0;
  std::vector<float> values;  ///< width · height
};

}  // namespace terrella
