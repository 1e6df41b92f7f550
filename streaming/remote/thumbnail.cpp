#include "streaming/remote/thumbnail.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace terrella {
namespace {

struct Range {
  int first, last;  ///< pixels, the last excluded; never empty
};

Range cell(int size_px, double from, double to, int index) {
  const double step = (to - from) / kThumbnailSide;
  const int first = std::clamp(static_cast<int>(std::lround(size_px * (from + step * index))), 0, size_px - 1);
  const int last = static_cast<int>(std::lround(size_px * (from + step * (index + 1))));
  return {first, std::clamp(last, first + 1, size_px)};
}

std::array<float, 3> mean_of(const Image& image, const Range& x, const Range& y) {
  std::array<double, 3> sum{};
  for (int row = y.first; row < y.last; ++row) {
    for (int column = x.first; column < x.last; ++column) {
      const std::size_t at = 4 * (static_cast<std::size_t>(row) * static_cast<std::size_t>(image.width_px) +
                                  static_cast<std::size_t>(column));
      const double alpha = image.rgba[at + 3] / 255.0;
      for (std::size_t c = 0; c < 3; ++c) sum[c] += alpha * image.rgba[at + c];
    }
  }
  const double count = static_cast<double>(x.last - x.first) * (y.last - y.first);
  return {static_cast<float>(sum[0] / count), static_cast<float>(sum[1] / count), static_cast<float>(sum[2] / count)};
}

}  // namespace

Thumbnail thumbnail_of(const Image& image, const PicturePart& part) {
  Thumbnail small{};
  std::size_t at = 0;
  for (int row = 0; row < kThumbnailSide; ++row) {
    const Range y = cell(image.height_px, part.top, part.bottom, row);
    for (int column = 0; column < kThumbnailSide; ++column, at += 3) {
      const auto mean = mean_of(image, cell(image.width_px, part.left, part.right, column), y);
      std::copy(mean.begin(), mean.end(), small.begin() + static_cast<std::ptrdiff_t>(at));
    }
  }
  return small;
}

double difference(const Thumbnail& a, const Thumbnail& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum / static_cast<double>(a.size()));
}

double contrast(const Thumbnail& picture) {
  Thumbnail mean{};
  for (std::size_t c = 0; c < 3; ++c) {
    double sum = 0.0;
    for (std::size_t i = c; i < picture.size(); i += 3) sum += picture[i];
    for (std::size_t i = c; i < picture.size(); i += 3)
      mean[i] = static_cast<float>(3.0 * sum / static_cast<double>(picture.size()));
  }
  return difference(picture, mean);
}

}  // namespace terrella
