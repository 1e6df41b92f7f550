#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "codecs/image.h"
#include "geo/camera.h"

namespace terrella {

/// The mean of pictures in linear light. Light adds up, while sRGB's coded values do not: a mean of those would darken
/// edges and blurred lights. Colours count as much as they are opaque. Equal pictures have themselves as their mean.
/// thread: one at a time
class LightSum {
 public:
  /// `size`: of the mean; the pictures are `box` times as wide and high, and each box of box × box pixels is averaged.
  LightSum(Viewport size, int box);
  void add(const Image& picture);
  /// The mean of at least one picture.
  [[nodiscard]] Image mean() const;

 private:
  struct Sum {
    std::uint64_t light[3] = {};
    std::uint64_t alpha = 0;
  };
  Viewport size_;
  std::size_t box_;
  std::uint64_t count_ = 0;  ///< pixels in each sum
  std::vector<Sum> sums_;
};

}  // namespace terrella
