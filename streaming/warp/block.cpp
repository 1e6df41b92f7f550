#include "streaming/warp/block.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace terrella {
namespace {

/// Reads and writes pixels as weighted sums: colours times alpha and alpha, or a number and 1. NaN weighs nothing.
struct Colours {
  using Pixels = Image;
  static constexpr std::size_t kSums = 4;
  static Image make(int width, int height) {
    return {width, height, std::vector<std::uint8_t>(static_cast<std::size_t>(width) * height * 4)};
  }
  static std::array<double, kSums> read(const Image& image, std::size_t at) {
    const std::uint8_t* from = image.rgba.data() + 4 * at;
    const double alpha = from[3] / 255.0;
    return {from[0] * alpha, from[1] * alpha, from[2] * alpha, alpha};
  }
  static void write(const std::array<double, kSums>& mean, Image& image, std::size_t at) {
    if (mean[3] <= 0.0) return;
    for (std::size_t c = 0; c < 3; ++c) {
      image.rgba[4 * at + c] = static_cast<std::uint8_t>(mean[c] / mean[3] + 0.5);
    }
    image.rgba[4 * at + 3] = static_cast<std::uint8_t>(mean[3] * 255.0 + 0.5);
  }
};

struct Values {
  using Pixels = Numbers;
  static constexpr std::size_t kSums = 2;
  static Numbers make(int width, int height) {
    return {width, height,
            std::vector<float>(static_cast<std::size_t>(width) * height, std::numeric_limits<float>::quiet_NaN())};
  }
  static std::array<double, kSums> read(const Numbers& numbers, std::size_t at) {
    const float value = numbers.values[at];
    return std::isfinite(value) ? std::array{double(value), 1.0} : std::array{0.0, 0.0};
  }
  static void write(const std::array<double, kSums>& mean, Numbers& numbers, std::size_t at) {
    if (mean[1] > 0.0) numbers.values[at] = static_cast<float>(mean[0] / mean[1]);
  }
};

template <class Kind>
typename Kind::Pixels averaged(const typename Kind::Pixels& from, int square) {
  auto to = Kind::make((from.width_px + square - 1) / square, (from.height_px + square - 1) / square);
  for (int y = 0; y < to.height_px; ++y) {
    for (int x = 0; x < to.width_px; ++x) {
      std::array<double, Kind::kSums> sum{};
      const int right = std::min((x + 1) * square, from.width_px), lower = std::min((y + 1) * square, from.height_px);
      for (int j = y * square; j < lower; ++j) {
        for (int i = x * square; i < right; ++i) {
          const auto pixel = Kind::read(from, static_cast<std::size_t>(j) * from.width_px + i);
          for (std::size_t c = 0; c < sum.size(); ++c) sum[c] += pixel[c];
        }
      }
      for (double& part : sum) part /= (right - x * square) * (lower - y * square);
      Kind::write(sum, to, static_cast<std::size_t>(y) * to.width_px + x);
    }
  }
  return to;
}

template <class Kind>
typename Kind::Pixels enlarged(const typename Kind::Pixels& from, int steps, std::int64_t part_x, std::int64_t part_y) {
  auto to = Kind::make(from.width_px, from.height_px);
  const double scale = std::ldexp(1.0, -steps);
  const auto place = [scale](std::int64_t part, int i, int side) {
    return std::clamp((static_cast<double>(part) * side + i + 0.5) * scale - 0.5, 0.0, side - 1.0);
  };
  for (int j = 0; j < to.height_px; ++j) {
    const double v = place(part_y, j, from.height_px);
    for (int i = 0; i < to.width_px; ++i) {
      const double u = place(part_x, i, from.width_px);
      std::array<double, Kind::kSums> sum{};
      for (int corner = 0; corner < 4; ++corner) {
        const int x = std::min(static_cast<int>(u) + corner % 2, from.width_px - 1);
        const int y = std::min(static_cast<int>(v) + corner / 2, from.height_px - 1);
        const double right = u - std::floor(u), lower = v - std::floor(v);
        const double weight = (corner % 2 == 1 ? right : 1.0 - right) * (corner / 2 == 1 ? lower : 1.0 - lower);
        const auto pixel = Kind::read(from, static_cast<std::size_t>(y) * from.width_px + x);
        for (std::size_t c = 0; c < sum.size(); ++c) sum[c] += weight * pixel[c];
      }
      Kind::write(sum, to, static_cast<std::size_t>(j) * to.width_px + i);
    }
  }
  return to;
}

}  // namespace

Block reduced(const Block& block, int halvings) {
  const int square = 1 << halvings;
  if (const auto* image = std::get_if<Image>(&block)) return averaged<Colours>(*image, square);
  return averaged<Values>(std::get<Numbers>(block), square);
}

Block enlarged_part(const Block& block, int steps, std::int64_t part_x, std::int64_t part_y) {
  if (const auto* image = std::get_if<Image>(&block)) return enlarged<Colours>(*image, steps, part_x, part_y);
  return enlarged<Values>(std::get<Numbers>(block), steps, part_x, part_y);
}

}  // namespace terrella
