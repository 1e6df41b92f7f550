#pragma once

#include <cstdint>
#include <vector>

#include "streaming/warp/block.h"

namespace terrella {

/// A rectangle of pixels, from its corner.
struct MeanBox {
  std::int64_t x = 0, y = 0;
  int width = 0, height = 0;
};

/// Position of the pixels of a file's level on the pixels of the result: result = corner + size · pixel.
struct PixelScale {
  double corner_x = 0.0, corner_y = 0.0;
  double size_x = 1.0, size_y = 1.0;         ///< result pixels in a pixel of the file, (0, 1.1]
  std::int64_t width_px = 0, height_px = 0;  ///< size of the level; blocks may reach beyond it
};

/// Means of files' pixels by area, for a rectangle of the result. Each file's pixel counts by the area that it covers,
/// so that neighbouring files join without a seam, whatever the size of their pixels. Pixels of equal size on one
/// lattice are copied exactly. Add files from the top: a file fills what those before leave uncovered. thread: one at a
/// time
class AreaMean {
 public:
  AreaMean(const MeanBox& box, bool numbers);

  /// Adds a block of the file on top of those left; (x, y) is the block's first pixel in the file's level.
  void add(const Block& block, std::int64_t x, std::int64_t y, const PixelScale& scale);
  /// Ends a file: its pixels cover those of the files below.
  void end_file();
  /// True if every pixel is covered.
  [[nodiscard]] bool is_full() const;
  /// The means. A number needs half of its pixel covered, else it is NaN.
  [[nodiscard]] Block finish() const;

 private:
  template <class Pixels>
  void add_rows(const Pixels& pixels, std::int64_t x, std::int64_t y, const PixelScale& scale);

  const MeanBox box_;
  const bool numbers_;
  const std::size_t channels_;
  std::vector<float> file_;   ///< sums of the file being added: values times weight, and the weight last
  std::vector<float> total_;  ///< the same of all files
};

}  // namespace terrella
