#include "apps/open_scene/eye_place.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "apps/process/console.h"
#include "surface/far_side_curtain.h"
#include "view/view_limits.h"

namespace terrella {
namespace {

constexpr double kOverGround_m = 1.0;

double lowest_eye_m(const SceneOptions& options, const Ellipsoid& e) {
  const auto& depth_m = options.surface.inner_sphere_below_m;
  return (depth_m ? inner_sphere_radius_m(e.a_m(), e.b_m(), *depth_m) : 0.0) - e.b_m();
}

/// Height from which the planet is one pixel wide.
double highest_eye_m(const Ellipsoid& e, const Camera& camera, Viewport picture) {
  const double pixels_per_radian = 0.5 * picture.height_px / std::tan(0.5 * camera.fov_y.rad());
  const double half_pixel_rad = std::min(0.5 / pixels_per_radian, 0.5 * std::numbers::pi);
  return std::max(height_range(e).highest_m, e.a_m() / std::sin(half_pixel_rad) - e.a_m());
}

}  // namespace

Status check_eye(const SceneOptions& options, const Body& body, Viewport picture) {
  if (!options.camera) return Done{};
  const double eye_m = options.camera->eye.height_m;
  const double lowest_m = lowest_eye_m(options, body.ellipsoid);
  const double highest_m = highest_eye_m(body.ellipsoid, *options.camera, picture);
  if (eye_m > lowest_m && eye_m <= highest_m) return Done{};
  const char* why = eye_m > highest_m ? "the planet is less than a pixel wide from there; a smaller FOV shows it"
                                      : "the inner sphere, or the planet's centre, is there; see --inner-sphere";
  return Error{fmt::format("ALT is {:.6g} m, but must be over {:.6g} m and at most {:.6g} m for this picture: {}",
                           eye_m, lowest_m, highest_m, why)};
}

bool may_be_underground(const SceneOptions& options) { return options.surface.alpha < 1.0 || options.has_objects(); }

Camera out_of_ground(Camera camera, double ground_m, bool may_be_under) {
  const double over_m = camera.eye.height_m - ground_m;
  if (over_m < kOverGround_m && (!may_be_under || over_m > -kOverGround_m)) {
    camera.eye.height_m = ground_m + kOverGround_m;
  }
  return camera;
}

void tell_of_move(const char* command, const Camera& eye, const Camera& over) {
  if (eye.eye.height_m + 2.0 * kOverGround_m > over.eye.height_m) return;
  print_message(
      "terrella {}: the eye at ALT {:.6g} m is under the ground, which is opaque; the picture is from 1 m over it "
      "(--surface-alpha under 1 shows what lies below)\n",
      command, eye.eye.height_m);
}

}  // namespace terrella
