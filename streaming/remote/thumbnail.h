#pragma once

#include <array>

#include "codecs/image.h"

namespace terrella {

/// Means of red, green and blue in 16 × 16 cells of a picture, in 8-bit levels. Averaging removes fine detail, JPEG
/// noise and the smoothing of coarser levels.
inline constexpr int kThumbnailSide = 16;
using Thumbnail = std::array<float, std::size_t{3} * kThumbnailSide * kThumbnailSide>;

/// A part of a picture, as fractions of its sides.
struct PicturePart {
  double left = 0.0, top = 0.0, right = 1.0, bottom = 1.0;
};

[[nodiscard]] Thumbnail thumbnail_of(const Image& image, const PicturePart& part = {});

/// Root mean square difference, levels. Transparent pixels count as black.
[[nodiscard]] double difference(const Thumbnail& a, const Thumbnail& b);
/// Standard deviation from the mean colour, levels.
[[nodiscard]] double contrast(const Thumbnail& picture);

}  // namespace terrella
