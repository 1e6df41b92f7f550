#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

#include "codecs/image.h"
#include "codecs/numbers.h"
#include "streaming/warp/warp_levels.h"

namespace terrella {

/// A tile of colours that is being made from sums of a canvas (canvas.h).
struct ColourTile {
  static constexpr std::size_t kChannels = 4;
  using Pixels = Image;
  static Image make(int side_px) {
    const auto side = static_cast<std::size_t>(side_px);
    return {side_px, side_px, std::vector<std::uint8_t>(side * side * 4)};
  }
  /// `coverage` is the part of the pixel that lies on the source, [0, 1].
  static void write(const float* sum, float coverage, Image& image, std::size_t at) {
    if (sum[3] < 0.5F) return;
    std::uint8_t* out = image.rgba.data() + 4 * at;
    const float to_plain = sum[3] > 254.5F && sum[3] < 255.5F ? 1.0F : 255.0F / sum[3];
    for (std::size_t c = 0; c < 3; ++c) out[c] = as_byte(sum[c] * to_plain);
    out[3] = as_byte(std::min(sum[3], 255.0F) * coverage);
  }
  /// Writes pixels side by side that lie on the source as a whole.
  static void write_row(const float* sums, std::size_t count, Image& image, std::size_t at) {
    std::size_t opaque = 0;
    for (std::size_t i = 3; i < 4 * count; i += 4)
      opaque += (sums[i] > 254.5F ? 1U : 0U) & (sums[i] < 255.5F ? 1U : 0U);
    if (opaque < count) {
      for (std::size_t i = 0; i < count; ++i) write(sums + 4 * i, 1.0F, image, at + i);
      return;
    }
    std::uint8_t* out = image.rgba.data() + 4 * at;
    for (std::size_t i = 0; i < 4 * count; ++i) out[i] = as_byte(sums[i]);
  }
  static void copy(const Image& from, const BlockPart& part, Image& to, std::size_t at) {
    for (int row = 0; row < part.height; ++row) {
      const auto first = static_cast<std::size_t>(part.y + row) * static_cast<std::size_t>(from.width_px) +
                         static_cast<std::size_t>(part.x);
      std::memcpy(to.rgba.data() + 4 * (at + static_cast<std::size_t>(row * to.width_px)), from.rgba.data() + 4 * first,
                  static_cast<std::size_t>(part.width) * 4);
    }
  }
  static bool is_whole(const float*) { return true; }

 private:
  /// Clamps the whole number, because the vectoriser gives up at a clamped float.
  static std::uint8_t as_byte(float value) {
    return static_cast<std::uint8_t>(std::clamp(static_cast<int>(value + 0.5F), 0, 255));
  }
};

/// The same of numbers: sums are the number times its weight, and the weight.
struct NumberTile {
  static constexpr std::size_t kChannels = 2;
  using Pixels = Numbers;
  static Numbers make(int side_px) {
    const auto side = static_cast<std::size_t>(side_px);
    return {side_px, side_px, std::vector<float>(side * side, std::numeric_limits<float>::quiet_NaN())};
  }
  static void write(const float* sum, float coverage, Numbers& numbers, std::size_t at) {
    if (sum[1] >= 0.5F && coverage >= 0.5F) numbers.values[at] = sum[0] / sum[1];
  }
  static void write_row(const float* sums, std::size_t count, Numbers& numbers, std::size_t at) {
    for (std::size_t i = 0; i < count; ++i) write(sums + 2 * i, 1.0F, numbers, at + i);
  }
  static void copy(const Numbers& from, const BlockPart& part, Numbers& to, std::size_t at) {
    for (int row = 0; row < part.height; ++row) {
      const auto first = static_cast<std::size_t>(part.y + row) * static_cast<std::size_t>(from.width_px) +
                         static_cast<std::size_t>(part.x);
      std::memcpy(to.values.data() + at + static_cast<std::size_t>(row * to.width_px), from.values.data() + first,
                  static_cast<std::size_t>(part.width) * sizeof(float));
    }
  }
  /// False if a number under the filter is missing. Negative weights would then overshoot, and are left out.
  static bool is_whole(const float* sum) { return std::abs(sum[1] - 1.0F) < 1e-4F; }
};

}  // namespace terrella
