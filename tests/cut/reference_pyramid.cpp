#include "reference_pyramid.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace terrella::test {
namespace {

double row_area(const Placement& placement, std::int64_t y) {
  const auto colatitude = [&](std::int64_t edge) {
    return std::min(180.0, static_cast<double>(edge) * placement.pixel_deg) * std::numbers::pi / 180.0;
  };
  return placement.equal_area ? 1.0 : std::cos(colatitude(y)) - std::cos(colatitude(y + 1));
}

}  // namespace

std::array<double, 4> mean_under(const Image& picture, const Placement& placement, int steps, std::int64_t x,
                                 std::int64_t y) {
  const std::int64_t side = std::int64_t{1} << steps;
  std::array<double, 4> sum{};
  double area = 0.0;
  for (std::int64_t row = y * side - placement.y0; row < (y + 1) * side - placement.y0; ++row) {
    if (row < 0 || row >= picture.height_px) continue;
    for (std::int64_t column = x * side - placement.x0; column < (x + 1) * side - placement.x0; ++column) {
      if (!placement.wraps && (column < 0 || column >= picture.width_px)) continue;
      const std::int64_t wrapped = (column + picture.width_px) % picture.width_px;
      const std::uint8_t* pixel = picture.rgba.data() + (row * picture.width_px + wrapped) * 4;
      const double weight = row_area(placement, row + placement.y0);
      for (std::size_t c = 0; c < 3; ++c) sum[c] += weight * pixel[c] * pixel[3];
      sum[3] += weight * pixel[3];
      area += weight;
    }
  }
  for (std::size_t c = 0; c < 3; ++c) sum[c] = sum[3] > 0.0 ? sum[c] / sum[3] : 0.0;
  sum[3] /= area;
  return sum;
}

}  // namespace terrella::test
