#include <algorithm>
#include <array>
#include <cmath>

#include "surface/height_field.h"

// Slopes of the ground at the middles of pixels.
namespace terrella {
namespace {

constexpr std::int64_t kReach_px = 2;  // pixels to each side of a slope

/// The derivative at the middle of five values, per step: exact for polynomials of fourth degree.
double derivative(double before_2, double before_1, double after_1, double after_2) {
  return (8.0 * (after_1 - before_1) - (after_2 - before_2)) / 12.0;
}

/// Rows and longitudes go on over a pole on the other side of the planet.
bool is_beyond_pole(double row_deg) { return std::abs(row_deg) > 90.0; }
double row_on_planet(double row_deg) {
  return is_beyond_pole(row_deg) ? std::copysign(180.0, row_deg) - row_deg : row_deg;
}

/// Columns between the heights of a slope along the parallel. Near a pole columns are so close that a height's rounding
/// to a metre would be a cliff, so heights are at least half as far apart as along the meridian. An arc of half a
/// radian still has its derivative within 0.2 %.
std::int64_t columns_apart(double north_over_east, double pixel_rad) {
  constexpr double kMostArc_rad = 0.5;
  return std::max(std::int64_t{1},
                  static_cast<std::int64_t>(std::min(0.5 * north_over_east, kMostArc_rad / pixel_rad)));
}

/// Place and weights of four values in a row, for a value between the middle two.
struct SplinePlace {
  std::int64_t first = 0;
  std::array<float, 4> weights{};
};

SplinePlace spline_place(double at) {
  const double whole = std::floor(at), f = at - whole, g = 1.0 - f;
  const double before = g * g * g / 6.0, after = f * f * f / 6.0;
  const double near = (4.0 - 3.0 * f * f * (2.0 - f)) / 6.0;
  return {static_cast<std::int64_t>(whole) - 1,
          {static_cast<float>(before), static_cast<float>(near), static_cast<float>(1.0 - before - near - after),
           static_cast<float>(after)}};
}

/// Places of the pixels -border_px … side + border_px of a tile in the pixels of its ancestor.
std::vector<SplinePlace> places_in(std::int64_t tile, std::int64_t ancestor, int levels_up, int side, int border_px) {
  std::vector<SplinePlace> places;
  for (int k = -border_px; k < side + border_px; ++k) {
    const double px = std::ldexp(static_cast<double>(tile * side + k) + 0.5, -levels_up) - 0.5;
    places.push_back(spline_place(px - static_cast<double>(ancestor * side)));
  }
  return places;
}

}  // namespace

std::vector<glm::vec2> HeightField::slopes(const TileId& id, int border_px) const {
  const std::int64_t side = grid_.tile_px + 2 * border_px;
  TileId loaded = id;
  while (!has(loaded) && loaded.level > grid_.min_level) loaded = parent(loaded);
  if (!has(loaded)) return std::vector<glm::vec2>(static_cast<std::size_t>(side * side), glm::vec2(0.0F));
  if (loaded == id) return slopes_within(id, {-border_px, -border_px, side, side});
  return finer_slopes(id, loaded, border_px);
}

std::vector<glm::vec2> HeightField::finer_slopes(const TileId& id, const TileId& loaded, int border_px) const {
  const int up = id.level - loaded.level;
  const std::vector<SplinePlace> columns = places_in(id.x, loaded.x, up, grid_.tile_px, border_px);
  const std::vector<SplinePlace> rows = places_in(id.y, loaded.y, up, grid_.tile_px, border_px);
  const PixelRect rect{columns.front().first, rows.front().first, columns.back().first + 4 - columns.front().first,
                       rows.back().first + 4 - rows.front().first};
  const std::vector<glm::vec2> coarse = slopes_within(loaded, rect);
  std::vector<glm::vec2> slopes;
  slopes.reserve(columns.size() * rows.size());
  for (const SplinePlace& row : rows) {
    for (const SplinePlace& column : columns) {
      glm::vec2 sum(0.0F);
      for (std::int64_t j = 0; j < 4; ++j) {
        const glm::vec2* four =
            &coarse[static_cast<std::size_t>((row.first - rect.y0 + j) * rect.width + column.first - rect.x0)];
        const std::array<float, 4>& w = column.weights;
        sum += row.weights[static_cast<std::size_t>(j)] *
               (w[0] * four[0] + w[1] * four[1] + w[2] * four[2] + w[3] * four[3]);
      }
      slopes.push_back(sum);
    }
  }
  return slopes;
}

std::vector<glm::vec2> HeightField::slopes_within(const TileId& id, const PixelRect& rect) const {
  const Held& held = *find(id);
  const double pixel_deg = size_of(id.level).span_deg / grid_.tile_px;
  const TileBounds bounds = tile_bounds(grid_, id);
  const auto row_of = [&](std::int64_t y) { return bounds.north_deg - (static_cast<double>(y) + 0.5) * pixel_deg; };
  const std::int64_t width = rect.width + 2 * kReach_px;
  std::vector<double> heights_m;
  heights_m.reserve(static_cast<std::size_t>(width * (rect.height + 2 * kReach_px)));
  Cursor beyond(*this);
  for (std::int64_t y = rect.y0 - kReach_px; y < rect.y0 + rect.height + kReach_px; ++y) {
    const double row = row_on_planet(row_of(y)), turn_deg = is_beyond_pole(row_of(y)) ? 180.0 : 0.0;
    for (std::int64_t x = rect.x0 - kReach_px; x < rect.x0 + rect.width + kReach_px; ++x) {
      const bool own = x >= 0 && y >= 0 && x < held.own_columns && y < held.own_rows;
      heights_m.push_back(
          own ? double{held.tile.heights_m[static_cast<std::size_t>(y * grid_.tile_px + x)]}
              : beyond.height_at_row_m(row, bounds.west_deg + turn_deg + (double(x) + 0.5) * pixel_deg));
    }
  }
  std::vector<glm::vec2> slopes;
  slopes.reserve(static_cast<std::size_t>(rect.width * rect.height));
  for (std::int64_t y = 0; y < rect.height; ++y) {
    const double row = row_of(rect.y0 + y);
    const auto lat_rad = [&](double row_deg) {
      return latitude_of_row(grid_, ellipsoid_, row_on_planet(row_deg)).rad();
    };
    const double north_m =
        std::max(1e-3, ellipsoid_.a_m() * std::abs(lat_rad(row + 0.5 * pixel_deg) - lat_rad(row - 0.5 * pixel_deg)));
    // Over a pole columns run the other way. Both axes stay those of this side, so that slopes can be interpolated.
    const double east_m = (is_beyond_pole(row) ? -1.0 : 1.0) * ellipsoid_.a_m() * Angle::degrees(pixel_deg).rad() *
                          std::max(1e-6, std::cos(lat_rad(row)));
    const double* h = &heights_m[static_cast<std::size_t>((y + kReach_px) * width + kReach_px)];
    const std::int64_t stride = columns_apart(north_m / std::abs(east_m), Angle::degrees(pixel_deg).rad());
    const auto height_m = [&](std::int64_t x) {
      if (x >= -kReach_px && x < rect.width + kReach_px) return h[x];
      const double turn_deg = is_beyond_pole(row) ? 180.0 : 0.0;
      return beyond.height_at_row_m(row_on_planet(row),
                                    bounds.west_deg + turn_deg + (static_cast<double>(rect.x0 + x) + 0.5) * pixel_deg);
    };
    for (std::int64_t x = 0; x < rect.width; ++x) {
      const double east =
          derivative(height_m(x - 2 * stride), height_m(x - stride), height_m(x + stride), height_m(x + 2 * stride)) /
          (static_cast<double>(stride) * east_m);
      slopes.emplace_back(east, derivative(h[x + 2 * width], h[x + width], h[x - width], h[x - 2 * width]) / north_m);
    }
  }
  return slopes;
}

}  // namespace terrella
