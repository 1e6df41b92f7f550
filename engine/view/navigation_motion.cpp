// The navigator's motions, step by step, and the limits that the ground sets to its eye.

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "view/navigation.h"
#include "view/view_limits.h"

namespace terrella {
namespace {

constexpr double kGlideStops_px_s = 4.0;
constexpr Seconds kGlideDecay(0.3);
constexpr Seconds kZoomDecay(0.07);
constexpr Seconds kPanDecay(0.08);
constexpr Seconds kNorthTime(0.6);
constexpr double kPanRest_px = 0.05;
constexpr double kZoomRest = 1e-4;  // a zoom ends this close to its target, as a fraction of the height
constexpr double kNorthEnough_deg = 0.01;

constexpr double kMostTexel_px = 8.0;  // the wheel stops where a texel covers more
constexpr double kAtStop = 1e-3;       // a height this near to the stop is at the stop, as a fraction
constexpr Seconds kSecondPush(0.4);    // after such a pause the wheel goes on beyond the stop

double decay(Seconds passed, Seconds time) { return std::exp(-passed / time); }

}  // namespace

double Navigator::lowest_m(const Geodetic& place) const {
  if (deepest_m_) return *deepest_m_;
  return ground_.height_m(place.lat, place.lon) + height_range(body()).lowest_m;
}

// Returns the height that zooming approaches: the point under the cursor if the eye is higher, else the ground below.
double Navigator::base_m(const Grab& held) const {
  if (!ground_.has_relief()) return 0.0;
  const double point_m = body().to_geodetic(held.point).height_m;
  if (held.on_surface && point_m < camera_.eye.height_m) return point_m;
  return ground_.height_m(camera_.eye.lat, camera_.eye.lon);
}

// Returns the new height over the target. Under the ground the eye approaches the ground from below.
double Navigator::nearer_m(double over_m, double factor) const {
  const HeightRange range = height_range(body());
  return deepest_m_ && over_m < 0.0 ? -range.clamp(-over_m * factor) : range.clamp(over_m * factor);
}

double Navigator::texel_stop_m(double texel_m) const {
  const double pixels_per_radian = 0.5 * viewport_.height_px / std::tan(0.5 * camera_.fov_y.rad());
  return texel_m * pixels_per_radian / kMostTexel_px;
}

// Height over the ground after a step of the wheel or a key, with the stop at the finest texels.
double Navigator::zoomed_m(double over_m, double factor, Seconds now) {
  const double wanted_m = nearer_m(over_m, factor);
  const Seconds pause = now - std::exchange(last_zoom_, now);
  const double stop_m = texel_stop_m(texel_m_.value_or(0.0));
  const bool crosses = over_m >= stop_m * (1.0 - kAtStop) && wanted_m < stop_m;
  const bool stands = over_m <= stop_m * (1.0 + kAtStop);
  at_texels_ = crosses && !(stands && pause > kSecondPush);
  return at_texels_ ? stop_m : wanted_m;
}

void Navigator::stay_over_ground() {
  if (deepest_m_ || !ground_.has_relief()) return;
  const double lowest = lowest_m(camera_.eye);
  if (camera_.eye.height_m < lowest) camera_.eye.height_m = lowest;
}

// Tilts the orbit by the least amount that keeps the eye over the ground. The pivot stays in place.
Orbit Navigator::over_ground(Orbit orbit, Angle fov_y) const {
  if (deepest_m_ || !ground_.has_relief()) return orbit;
  const auto free = [&](Angle depression) {
    Orbit tried = orbit;
    tried.depression = depression;
    const Camera camera = orbit_camera(tried, body(), fov_y);
    return camera.eye.height_m >= lowest_m(camera.eye);
  };
  Angle buried = orbit.depression, clear = buried;
  while (!free(clear)) {
    if (clear >= Angle::degrees(90.0)) return orbit;
    buried = clear;
    clear = std::min(clear + Angle::degrees(1.0), Angle::degrees(90.0));
  }
  for (int k = 0; k < 20 && clear != orbit.depression; ++k) {
    const Angle middle = 0.5 * (buried + clear);
    (free(middle) ? clear : buried) = middle;
  }
  orbit.depression = clear;
  return orbit;
}

Navigator::Motion Navigator::go_on(Rest rest, Seconds) { return rest; }
Navigator::Motion Navigator::go_on(Led led, Seconds) { return led; }
Navigator::Motion Navigator::go_on(Drag drag, Seconds) { return drag; }
Navigator::Motion Navigator::go_on(Turn turn, Seconds) { return turn; }

Navigator::Motion Navigator::go_on(Glide glide, Seconds passed) {
  const double left = decay(passed, kGlideDecay);
  shift(glide.at_px, glide.speed_px_s * (1.0 - left) * kGlideDecay.count());
  glide.speed_px_s *= left;
  if (glm::length(glide.speed_px_s) < kGlideStops_px_s) return Rest{};
  return glide;
}

Navigator::Motion Navigator::go_on(Zoom zoom, Seconds passed) {
  const double nearest_m = std::copysign(height_range(body()).lowest_m, zoom.target_m);
  const double ratio = std::max(1.0, (camera_.eye.height_m - zoom.base_m) / nearest_m) * nearest_m / zoom.target_m;
  const double left = std::pow(ratio, decay(passed, kZoomDecay));
  const bool done = std::abs(std::log(left)) < kZoomRest;
  set_height(zoom.base_m + (done ? zoom.target_m : zoom.target_m * left));
  // While zooming out, the globe can shrink away from the cursor. From then on its place in the picture is kept.
  zoom.holds = zoom.holds && grab_at(zoom.at_px).on_surface;
  if (zoom.holds) pin_to(zoom.held, zoom.at_px, zoom.rule);
  if (done) return Rest{};
  return zoom;
}

Navigator::Motion Navigator::go_on(Pan pan, Seconds passed) {
  const double left = decay(passed, kPanDecay);
  const bool done = glm::length(pan.left_px) * left < kPanRest_px;
  const glm::dvec2 step_px = done ? pan.left_px : pan.left_px * (1.0 - left);
  shift(centre_px(), step_px);
  pan.left_px -= step_px;
  if (done) return Rest{};
  return pan;
}

Navigator::Motion Navigator::go_on(Fly fly, Seconds passed) {
  fly.flown += passed;
  camera_ = flight_camera(fly.flight, fly.flown);
  if (fly.flown >= fly.flight.duration) return Rest{};
  return fly;
}

Navigator::Motion Navigator::go_on(TurnNorth north, Seconds passed) {
  north.turned += passed;
  const double share = ease_in_out(north.turned / kNorthTime);
  const Angle short_way = Angle::radians(std::remainder(north.from.rad(), Angle::degrees(360.0).rad()));
  camera_.heading = (1.0 - share) * short_way;
  if (north.centre.on_surface) pin_to(north.centre.point, centre_px(), HeadingRule::keep);
  if (north.turned < kNorthTime) return north;
  if (std::abs(camera_.heading.deg()) > kNorthEnough_deg) camera_.heading = Angle{};
  return Rest{};
}

}  // namespace terrella
