#include "view/view_limits.h"

#include <algorithm>
#include <cmath>

namespace terrella {
namespace {

constexpr double kLowest_m = 1.0;
constexpr double kHighest_radii = 50.0;
// fraction of the field of view that may show sky above the horizon, over the picture's centre
constexpr double kSkyShare = 0.45;
constexpr double kGlobeShare = 0.85;  // fraction of the picture's shorter side

}  // namespace

double HeightRange::clamp(double height_m) const {
  return height_m > lowest_m ? std::min(height_m, highest_m) : lowest_m;
}

HeightRange height_range(const Ellipsoid& ellipsoid) { return {kLowest_m, kHighest_radii * ellipsoid.a_m()}; }

Angle highest_pitch(const Ellipsoid& ellipsoid, double height_m, Angle fov_y) {
  const double ratio = ellipsoid.a_m() / (ellipsoid.a_m() + std::max(height_m, 0.0));
  const Angle horizon = Angle::radians(std::asin(ratio)) - Angle::degrees(90.0);
  return std::min(horizon + kSkyShare * fov_y, Angle::degrees(90.0));
}

double whole_globe_height_m(const Ellipsoid& ellipsoid, Angle fov_y, Viewport viewport) {
  const double shorter = std::min(1.0, double(viewport.width_px) / double(viewport.height_px));
  const double radius_rad = std::atan(kGlobeShare * shorter * std::tan(0.5 * fov_y.rad()));
  return height_range(ellipsoid).clamp(ellipsoid.a_m() / std::sin(radius_rad) - ellipsoid.a_m());
}

}  // namespace terrella
