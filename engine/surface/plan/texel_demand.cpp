#include "surface/plan/texel_demand.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

namespace terrella {
namespace {

// A level is coarse enough if its texels are at most 2^0.02 pixels: a rounding of 1.4 % spares half of the borderline
// tiles.
constexpr double kLevelRounding = 0.02;
// A cell larger than this part of its distance has pixels of too different size: its middle cannot stand for all.
constexpr double kLargeCell = 0.25;
// A picture of the equator wants twice as many texels as it has pixels; one of the pole, in a full grid, six times. A
// view that wants more than this, in more tiles than these, takes longer texels (bench stream, bench accuracy).
constexpr double kMostTexelsAPixel = 5.5;
constexpr int kFewTiles = 64;
// Most pixels that such a texel is long along the meridian, and the squared cosine of the latitude from which on texels
// are about a quarter as wide as long: these stay short.
constexpr double kLongestTexel_px = 1.55, kCloseToPole = 0.07;

}  // namespace

TexelDemand::TexelDemand(const View& view, const Ellipsoid& ellipsoid, const TileGrid& grid, double texels_per_pixel)
    : view_(view),
      grid_(grid),
      texels_per_pixel_(texels_per_pixel),
      radians_per_pixel_(1.0 / view.pixels_per_radian()) {
  const double texel0_m = ellipsoid.a_m() * (std::numbers::pi / 180.0) * grid.root_span_deg / grid.tile_px;
  texel0_asked_m_ = texel0_m * texels_per_pixel;
}

double TexelDemand::coarse_enough(int level) { return std::exp2(level - 1 + kLevelRounding); }

int TexelDemand::levels_to_spare(const TileId& id, const CellExtent& cell, double most_texels) const {
  const Texels texels = wanted(cell);
  int spare = 0;
  for (; spare < id.level - grid_.min_level; most_texels *= 0.5, ++spare) {
    if (texels.meridian > most_texels) break;
    const int squeeze = grid_.reduced ? squeeze_of_row(grid_, id.level - spare - 1, id.y >> (spare + 1)) : 0;
    if ((squeeze == 0 ? texels.parallel : std::ldexp(texels.parallel, squeeze)) > most_texels) break;
  }
  return spare;
}

// Measured in the middle of the cell.
TexelDemand::Texels TexelDemand::wanted(const CellExtent& cell) const {
  constexpr double kAll = std::numeric_limits<double>::infinity();
  const glm::dvec3 to_eye = view_.eye.xyz_m - cell.whole.center_m;
  const glm::dvec3& normal = cell.up;
  const double distance_m = std::max(glm::length(to_eye), 1e-9);
  if (cell.whole.radius_m > kLargeCell * distance_m) return {kAll, kAll};
  const double up = std::clamp(glm::dot(to_eye, normal) / distance_m, 0.05, 1.0);
  const double cos_lat2 = std::max(normal.x * normal.x + normal.y * normal.y, 1e-18);
  const double east = (normal.x * to_eye.y - normal.y * to_eye.x) / distance_m;
  const double sine2 = std::min(1.0, east * east / (cos_lat2 * std::max(1e-18, 1.0 - up * up)));
  // A pixel on the ground is `across` wide and across/up long. sine2 is the squared sine of the angle between its
  // length and the meridian. Along an axis it resolves as much as the ellipse of its frequencies reaches there.
  const double north2 = (1.0 - sine2) * up * up + sine2, parallel2 = sine2 * up * up + 1.0 - sine2;
  const double texels = texel0_asked_m_ / (distance_m * radians_per_pixel_);
  return {texels * std::sqrt(north2) / length_px(cos_lat2), texels * std::sqrt(cos_lat2 * parallel2)};
}

bool TexelDemand::is_too_much(int tiles) const {
  const double texels = double(tiles) * grid_.tile_px * grid_.tile_px;
  const double pixels = double(view_.viewport.width_px) * view_.viewport.height_px;
  return !grid_.reduced && tiles > kFewTiles &&
         texels > kMostTexelsAPixel * texels_per_pixel_ * texels_per_pixel_ * pixels;
}

// Most pixels that a texel is long along the meridian. A lengthened texel covers no more than a pixel. Close to a pole
// the picture needs all detail along the meridian.
double TexelDemand::length_px(double cos_lat2) const {
  if (!narrow_texels_are_long_ || cos_lat2 < kCloseToPole) return 1.0;
  return std::min(kLongestTexel_px, 1.0 / std::sqrt(std::sqrt(cos_lat2)));
}

}  // namespace terrella
