#include "view/stereo.h"

#include <algorithm>
#include <cmath>

namespace terrella {
namespace {

constexpr double kSeparationPerDistance = 1.0 / 30.0;
constexpr double kLeastConvergence_m = 0.1;

View eye_beside(View view, double right_m, double convergence_m) {
  view.eye.xyz_m += right_m * view.right;
  view.shear_x -= right_m / convergence_m;
  return view;
}

}  // namespace

EyePair stereo_eyes(const View& view, const Ground& ground, const StereoLook& look) {
  EyePair pair;
  const double over_m = std::abs(ground.height_over_m(ground.ellipsoid().to_geodetic(view.eye)));
  const std::optional<double> ahead_m =
      ground.intersect_m(view.eye, EcefDir{view.forward}, 1.0 / view.pixels_per_radian());
  pair.convergence_m = std::max(kLeastConvergence_m, ahead_m.value_or(over_m));
  double natural_m = kSeparationPerDistance * pair.convergence_m;
  // Prevents an eye from entering the mountain beside it.
  if (ground.has_relief()) natural_m = std::min(natural_m, over_m);
  pair.separation_m = look.eye_separation_m.value_or(natural_m);
  const double half_m = 0.5 * pair.separation_m;
  pair.left = eye_beside(view, -half_m, pair.convergence_m);
  pair.right = eye_beside(view, half_m, pair.convergence_m);
  pair.both = view;
  pair.both.eye_spread_m = half_m;
  // The shear extends each picture to one side.
  const double slope_per_px = 2.0 * view.tan_half_fov_y / view.viewport.height_px;
  pair.both.viewport.width_px +=
      2 * static_cast<int>(std::ceil(std::min(1.0e4, half_m / pair.convergence_m / slope_per_px)));
  return pair;
}

}  // namespace terrella
