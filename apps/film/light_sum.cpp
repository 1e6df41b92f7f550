#include "apps/film/light_sum.h"

#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>

namespace terrella {
namespace {

constexpr std::size_t kLevels = 256;
constexpr std::uint64_t kMostLight = 65535;  // 20 for the darkest level over 0

/// Conversions of sRGB (IEC 61966-2-1).
struct LightTables {
  std::array<std::uint64_t, kLevels> light{};
  std::array<std::uint8_t, kMostLight + 1> level{};

  LightTables() {
    for (std::size_t k = 0; k < kLevels; ++k) {
      const double coded = double(k) / 255.0;
      const double linear = coded <= 0.04045 ? coded / 12.92 : std::pow((coded + 0.055) / 1.055, 2.4);
      light[k] = static_cast<std::uint64_t>(std::lround(linear * double(kMostLight)));
    }
    for (std::size_t k = 0; k < level.size(); ++k) {
      const double linear = double(k) / double(kMostLight);
      const double coded = linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
      level[k] = static_cast<std::uint8_t>(std::lround(255.0 * coded));
    }
  }
};

const LightTables& tables() {
  static const LightTables made;
  return made;
}

std::uint64_t rounded(std::uint64_t sum, std::uint64_t count) { return (sum + count / 2) / count; }

}  // namespace

LightSum::LightSum(Viewport size, int box)
    : size_(size),
      box_(static_cast<std::size_t>(box)),
      sums_(static_cast<std::size_t>(size.width_px) * static_cast<std::size_t>(size.height_px)) {}

void LightSum::add(const Image& picture) {
  const LightTables& table = tables();
  const auto width = static_cast<std::size_t>(size_.width_px), height = static_cast<std::size_t>(size_.height_px);
  assert(picture.rgba.size() == 4 * sums_.size() * box_ * box_);
  const std::uint8_t* pixel = picture.rgba.data();
  for (std::size_t y = 0; y < height * box_; ++y) {
    Sum* const row = sums_.data() + y / box_ * width;
    for (std::size_t x = 0; x < width; ++x) {
      for (std::size_t k = 0; k < box_; ++k, pixel += 4) {
        const std::uint64_t alpha = pixel[3];
        for (std::size_t c = 0; c < 3; ++c) row[x].light[c] += alpha * table.light[pixel[c]];
        row[x].alpha += alpha;
      }
    }
  }
  count_ += box_ * box_;
}

Image LightSum::mean() const {
  const LightTables& table = tables();
  Image image{size_.width_px, size_.height_px, std::vector<std::uint8_t>(4 * sums_.size())};
  std::uint8_t* pixel = image.rgba.data();
  for (const Sum& sum : sums_) {
    for (std::size_t c = 0; c < 3 && sum.alpha > 0; ++c) pixel[c] = table.level[rounded(sum.light[c], sum.alpha)];
    pixel[3] = static_cast<std::uint8_t>(rounded(sum.alpha, count_));
    pixel += 4;
  }
  return image;
}

}  // namespace terrella
