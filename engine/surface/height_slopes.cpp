#include <algorithm>
#include <cassert>
#include <cmath>

#include "surface/height_field.h"

// Slopes of the ground at the middles of pixels.
namespace terrella {
namespace {

constexpr int kReach_px = 2;  // pixels to each side of a slope

/// Heights of a square of pixels.
struct HeightSquare {
  std::int64_t side;
  std::vector<double> heights_m;
  [[nodiscard]] double at(std::int64_t x, std::int64_t y) const {
    return heights_m[static_cast<std::size_t>(y * side + x)];
  }
};

/// The derivative at the middle of five values, per step: exact for polynomials of fourth degree.
double derivative(double before_2, double before_1, double after_1, double after_2) {
  return (8.0 * (after_1 - before_1) - (after_2 - before_2)) / 12.0;
}

}  // namespace

std::vector<glm::vec2> HeightField::slopes(const TileId& id, int border_px) const {
  const Held* held = find(id);
  assert(held != nullptr);
  const double pixel_deg = size_of(id.level).span_deg / grid_.tile_px;
  const TileBounds bounds = tile_bounds(grid_, id);
  const auto row_of = [&](std::int64_t y) { return bounds.north_deg - (static_cast<double>(y) + 0.5) * pixel_deg; };
  const std::int64_t around = border_px + kReach_px;
  HeightSquare square{.side = grid_.tile_px + 2 * around, .heights_m = {}};
  square.heights_m.reserve(static_cast<std::size_t>(square.side * square.side));
  Cursor beyond(*this);
  for (std::int64_t y = -around; y < grid_.tile_px + around; ++y) {
    // Beyond a pole the last row repeats.
    const double row = std::clamp(row_of(y), bottom_row_deg(grid_) + 0.5 * pixel_deg, 90.0 - 0.5 * pixel_deg);
    for (std::int64_t x = -around; x < grid_.tile_px + around; ++x) {
      const bool own = x >= 0 && y >= 0 && x < held->own_columns && y < held->own_rows;
      square.heights_m.push_back(
          own ? static_cast<double>(held->tile.heights_m[static_cast<std::size_t>(y * grid_.tile_px + x)])
              : beyond.height_at_row_m(row, bounds.west_deg + (static_cast<double>(x) + 0.5) * pixel_deg));
    }
  }
  std::vector<glm::vec2> slopes;
  slopes.reserve(static_cast<std::size_t>(square.side * square.side));
  for (std::int64_t y = kReach_px; y < square.side - kReach_px; ++y) {
    const double row = row_of(y - around);
    const double lat = latitude_of_row(grid_, ellipsoid_, row).rad();
    const double north_m = ellipsoid_.a_m() * (latitude_of_row(grid_, ellipsoid_, row + 0.5 * pixel_deg).rad() -
                                               latitude_of_row(grid_, ellipsoid_, row - 0.5 * pixel_deg).rad());
    const double east_m = ellipsoid_.a_m() * Angle::degrees(pixel_deg).rad() * std::max(1e-6, std::cos(lat));
    for (std::int64_t x = kReach_px; x < square.side - kReach_px; ++x) {
      const double east =
          derivative(square.at(x - 2, y), square.at(x - 1, y), square.at(x + 1, y), square.at(x + 2, y));
      const double north =
          derivative(square.at(x, y + 2), square.at(x, y + 1), square.at(x, y - 1), square.at(x, y - 2));
      slopes.emplace_back(east / east_m, north / std::max(north_m, 1e-3));
    }
  }
  return slopes;
}

}  // namespace terrella
