#include "apps/viewer/parts/underground.h"

#include <algorithm>
#include <utility>

namespace terrella {
namespace {

constexpr double kEarthEquator_m = 6378137.0;
constexpr double kDeepest = 0.8;  // share of the way down to the inner sphere

}  // namespace

Underground::Underground(const ViewerContext& context) : Part(context) {
  if (context_.navigator.camera().eye.height_m < 0.0) context_.navigator.set_deepest(deepest_m());
}

double Underground::deepest_m() const {
  const GlobeOptions& globe = context_.globe.options();
  const double below_m = globe.surface.inner_sphere_below_m.value_or(kEarthEquator_m);
  return -kDeepest * below_m * (globe.body.ellipsoid.a_m() / kEarthEquator_m);
}

bool Underground::is_below() const {
  const Geodetic eye = context_.navigator.camera().eye;
  return eye.height_m < context_.globe.ground_height_m(eye.lat, eye.lon);
}

void Underground::toggle() {
  if (is_below()) {
    return_above();
    return say("Above the ground");
  }
  Camera camera = context_.navigator.camera();
  const double ground_m = context_.globe.ground_height_m(camera.eye.lat, camera.eye.lon);
  above_ = camera;
  context_.navigator.set_deepest(deepest_m());
  camera.eye.height_m = std::max(2.0 * ground_m - camera.eye.height_m, deepest_m());
  camera.pitch = Angle::degrees(std::max(30.0, -camera.pitch.deg()));
  context_.navigator.set_camera(camera);
  say("Under the ground; X returns");
}

void Underground::return_above() {
  if (!is_below()) return context_.navigator.set_deepest({});
  Camera camera = context_.navigator.camera();
  camera.eye.height_m = 2.0 * context_.globe.ground_height_m(camera.eye.lat, camera.eye.lon) - camera.eye.height_m;
  camera.pitch = Angle::degrees(-90.0);
  if (above_) camera = *std::exchange(above_, std::nullopt);
  context_.navigator.set_deepest({});
  context_.navigator.set_camera(camera);
}

}  // namespace terrella
