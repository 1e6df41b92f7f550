#include "view/navigation.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "view/view_limits.h"

namespace terrella {
namespace {

constexpr Seconds kLongestStep(0.25);  // longest time that one call passes, after a slow frame or a jump of the clock
constexpr Seconds kFlickMemory(0.1);   // a pointer that rests this long before its release does not flick
constexpr Seconds kFlickBase(0.15);    // time over which the speed of a flick is measured
constexpr Seconds kShortestFlick(0.03);
constexpr Seconds kLatestFlick(0.5);  // with a later event, a flick cannot be told from a rest
constexpr double kSlowestFlick_px_s = 60.0;
constexpr double kClickSlack_px = 6.0;  // movement of the hand that still counts as a click
constexpr double kFastestFlick_px_s = 6000.0;
constexpr double kGlideStops_px_s = 4.0;
constexpr Seconds kGlideDecay(0.3);
constexpr Seconds kZoomDecay(0.07);
constexpr Seconds kPanDecay(0.08);
constexpr Seconds kNorthTime(0.6);
constexpr double kPanRest_px = 0.05;
constexpr double kZoomRest = 1e-4;    // a zoom ends this close to its target, as a fraction of the height
constexpr double kWheelFactor = 0.8;  // factor of the height per wheel step
constexpr double kKeyFactor = 0.65;
constexpr double kLeastPinch = 0.1;  // smallest factor of one pinch event; a smaller one is a device's error
constexpr double kPanShare = 0.12;   // fraction of the picture's shorter side per key press
constexpr double kFlyFactor = 0.4;   // factor of the height for a double click
constexpr double kTurnPerWidth_deg = 270.0;
constexpr double kTiltPerHeight_deg = 120.0;
constexpr double kLowestDepression_deg = 2.0;
constexpr double kNorthEnough_deg = 0.01;

bool finite(glm::dvec2 v) { return std::isfinite(v.x) && std::isfinite(v.y); }
bool finite(Seconds t) { return std::isfinite(t.count()); }
double decay(Seconds passed, Seconds time) { return std::exp(-passed / time); }

Viewport at_least_one(Viewport viewport) { return {std::max(viewport.width_px, 1), std::max(viewport.height_px, 1)}; }

glm::dvec2 limited(glm::dvec2 speed, double most) {
  const double length = glm::length(speed);
  return length > most ? speed * (most / length) : speed;
}

}  // namespace

Navigator::Navigator(const Camera& camera, const Ground& ground, Viewport viewport)
    : camera_(camera), ground_(ground), viewport_(at_least_one(viewport)) {}

void Navigator::set_viewport(Viewport viewport) { viewport_ = at_least_one(viewport); }

void Navigator::set_camera(const Camera& camera) {
  camera_ = camera;
  motion_ = Rest{};
}

void Navigator::set_ground(const Ground& ground) {
  ground_ = ground;
  stay_over_ground();
}

bool Navigator::animating() const {
  return !std::holds_alternative<Rest>(motion_) && !std::holds_alternative<Drag>(motion_) &&
         !std::holds_alternative<Turn>(motion_);
}

// --- events

void Navigator::pointer_down(PointerButton button, bool ctrl, glm::dvec2 at_px, Seconds now) {
  if (!finite(at_px) || !finite(now)) return;
  advance(now);
  if (button == PointerButton::left && !ctrl) {
    const Grab held = grab_at(at_px);
    motion_ = Drag{camera_, held.point, heading_rule(camera_, body(), held.point), at_px, {{at_px, now}}};
    return;
  }
  const Grab centre = grab_at(centre_px());
  Turn turn{{}, camera_, at_px};
  if (centre.on_surface) turn.orbit = orbit_around(camera_, body(), centre.point);
  motion_ = turn;
}

void Navigator::pointer_move(glm::dvec2 at_px, Seconds now) {
  if (!finite(at_px) || !finite(now)) return;
  (void)pass(now);
  if (const Turn* turn = std::get_if<Turn>(&motion_)) {
    turn_to(*turn, at_px);
    stay_over_ground();
  }
  Drag* drag = std::get_if<Drag>(&motion_);
  if (drag == nullptr || drag->trail.back().at_px == at_px) return;
  std::erase_if(drag->trail, [&](const Sample& s) { return s.when > now || now - s.when > kFlickBase; });
  drag->trail.push_back({at_px, now});
  pin_drag(*drag);
  stay_over_ground();
}

void Navigator::pointer_up(PointerButton, Seconds now, Seconds late) {
  if (!finite(now)) return;
  (void)pass(now);
  const Drag* drag = std::get_if<Drag>(&motion_);
  const glm::dvec2 speed_px_s = drag != nullptr ? flick_px_s(*drag, now, late) : glm::dvec2(0.0);
  if (glm::length(speed_px_s) > kSlowestFlick_px_s) {
    motion_ = Glide{drag->trail.back().at_px, speed_px_s};
  } else if (!animating()) {
    motion_ = Rest{};
  }
}

void Navigator::double_click(glm::dvec2 at_px, Seconds now) {
  if (!finite(at_px) || !finite(now)) return;
  advance(now);
  const Grab there = grab_at(at_px);
  if (!there.on_surface) return;
  Camera target = camera_;
  const double base = base_m(there);
  target.eye.height_m = base + nearer_m(camera_.eye.height_m - base, kFlyFactor);
  target.pitch = std::min(target.pitch, highest_pitch(body(), target.eye.height_m, Angle{}) - Angle::degrees(5.0));
  start_flight(pin(target, body(), viewport_, there.point, centre_px(), heading_rule(camera_, body(), there.point)));
}

void Navigator::wheel(glm::dvec2 at_px, double steps, Seconds now) {
  if (!finite(at_px) || !std::isfinite(steps) || !finite(now)) return;
  advance(now);
  const double factor = std::pow(kWheelFactor, std::clamp(steps, -20.0, 20.0));
  if (Drag* drag = std::get_if<Drag>(&motion_)) {
    const double base = base_m({drag->held, true});
    set_height(base + nearer_m(camera_.eye.height_m - base, factor));
    drag->start = camera_;
    pin_drag(*drag);
  } else if (!std::holds_alternative<Turn>(motion_)) {
    zoom_by(factor, at_px);
  }
}

void Navigator::pinch(glm::dvec2 at_px, double factor, Seconds now) {
  if (!finite(at_px) || !std::isfinite(factor) || factor <= 0.0 || !finite(now)) return;
  advance(now);
  if (std::holds_alternative<Drag>(motion_) || std::holds_alternative<Turn>(motion_)) return;
  motion_ = Rest{};
  const Grab held = grab_at(at_px);
  const HeadingRule rule = heading_rule(camera_, body(), held.point);
  const double base = base_m(held);
  set_height(base + nearer_m(camera_.eye.height_m - base, 1.0 / std::clamp(factor, kLeastPinch, 1.0 / kLeastPinch)));
  if (held.on_surface && grab_at(at_px).on_surface) pin_to(held.point, at_px, rule);
  stay_over_ground();
}

void Navigator::fly_to(const Camera& camera, Seconds now) {
  const Geodetic& eye = camera.eye;
  const double all = eye.lat.rad() + eye.lon.rad() + eye.height_m + camera.heading.rad() + camera.pitch.rad();
  if (!std::isfinite(all + camera.fov_y.rad()) || !finite(now)) return;
  advance(now);
  start_flight(camera);
}

void Navigator::key(NavigationKey key, Seconds now) {
  if (!finite(now)) return;
  advance(now);
  if (std::holds_alternative<Drag>(motion_) || std::holds_alternative<Turn>(motion_)) return;
  const double pan_px = kPanShare * std::min(viewport_.width_px, viewport_.height_px);
  switch (key) {
    case NavigationKey::pan_left:
      return pan_by({pan_px, 0.0});
    case NavigationKey::pan_right:
      return pan_by({-pan_px, 0.0});
    case NavigationKey::pan_up:
      return pan_by({0.0, pan_px});
    case NavigationKey::pan_down:
      return pan_by({0.0, -pan_px});
    case NavigationKey::zoom_in:
      return zoom_by(kKeyFactor, {});
    case NavigationKey::zoom_out:
      return zoom_by(1.0 / kKeyFactor, {});
    case NavigationKey::north_up:
      motion_ = TurnNorth{grab_at(centre_px()), camera_.heading};
      return;
    case NavigationKey::whole_globe:
      return go_whole_globe();
  }
}

void Navigator::advance(Seconds now) {
  if (!finite(now)) return;
  const Seconds passed = pass(now);
  motion_ = std::visit([&](auto motion) { return go_on(motion, passed); }, motion_);
  stay_over_ground();
}

//  --- helpers of the events

Seconds Navigator::pass(Seconds now) {
  const Seconds passed = clock_ ? std::clamp(Seconds(now - *clock_), Seconds(0.0), kLongestStep) : Seconds(0.0);
  clock_ = now;
  return passed;
}

glm::dvec2 Navigator::centre_px() const { return {0.5 * viewport_.width_px, 0.5 * viewport_.height_px}; }

Grab Navigator::grab_at(glm::dvec2 at_px) const { return grab(make_view(camera_, body(), viewport_), ground_, at_px); }

void Navigator::pin_to(const Ecef& point, glm::dvec2 at_px, HeadingRule rule) {
  camera_ = pin(camera_, body(), viewport_, point, at_px, rule);
}

void Navigator::pin_drag(const Drag& drag) {
  // A carried heading depends on the way. Starting from the drag's first camera each time, a drag out and back ends
  // where it began. A kept heading has two solutions near a pole. Continuing from the last camera stays on one branch.
  const Camera& from = drag.rule == HeadingRule::carry ? drag.start : camera_;
  camera_ = pin(from, body(), viewport_, drag.held, drag.trail.back().at_px, drag.rule);
}

glm::dvec2 Navigator::flick_px_s(const Drag& drag, Seconds now, Seconds late) {
  const Sample& last = drag.trail.back();
  const bool rested = last.when > now || now - last.when > kFlickMemory || late > kLatestFlick;
  if (rested || glm::distance(last.at_px, drag.from_px) <= kClickSlack_px) return glm::dvec2(0.0);
  // Measured over the whole trail, not between its samples: a slow frame delivers many moves at one time.
  const Sample& first = drag.trail.front();
  const Seconds took = std::max({Seconds(now - first.when), kShortestFlick, late});
  return limited((last.at_px - first.at_px) / took.count(), kFastestFlick_px_s);
}

void Navigator::shift(glm::dvec2 from_px, glm::dvec2 by_px) {
  const Grab held = grab_at(from_px);
  pin_to(held.point, from_px + by_px, heading_rule(camera_, body(), held.point));
}

void Navigator::set_height(double height_m) {
  const double highest_m = height_range(body()).highest_m, lowest = lowest_m(camera_.eye);
  const double clamped_m = height_m > lowest ? std::min(height_m, highest_m) : lowest;
  if (clamped_m > camera_.eye.height_m) {
    // While zooming out, a tilted eye looks further down, so that the globe stays in view.
    camera_.pitch = std::min(camera_.pitch, highest_pitch(body(), clamped_m, camera_.fov_y));
  }
  camera_.eye.height_m = clamped_m;
}

void Navigator::zoom_by(double factor, std::optional<glm::dvec2> at_px) {
  const Zoom* running = std::get_if<Zoom>(&motion_);
  const double from_m = running != nullptr ? running->base_m + running->target_m : camera_.eye.height_m;
  const glm::dvec2 px = at_px.value_or(centre_px());
  const Grab held = grab_at(px);
  const double base = base_m(held);
  motion_ = Zoom{held.point,
                 held.on_surface,
                 heading_rule(camera_, body(), held.point),
                 px,
                 base,
                 nearer_m(from_m - base, factor)};
}

void Navigator::pan_by(glm::dvec2 by_px) {
  const Pan* running = std::get_if<Pan>(&motion_);
  motion_ = Pan{by_px + (running != nullptr ? running->left_px : glm::dvec2(0.0))};
}

void Navigator::start_flight(const Camera& camera) { motion_ = Fly{plan_flight(camera_, camera, body())}; }

void Navigator::go_whole_globe() {
  Camera target = camera_;
  target.eye.height_m = whole_globe_height_m(body(), camera_.fov_y, viewport_);
  target.heading = Angle{};
  target.pitch = Angle::degrees(-90.0);
  start_flight(target);
}

void Navigator::turn_to(const Turn& turn, glm::dvec2 at_px) {
  const glm::dvec2 moved = (at_px - turn.from_px) / glm::dvec2(viewport_.width_px, viewport_.height_px);
  const Angle turned = Angle::degrees(kTurnPerWidth_deg * moved.x);
  const Angle tilted = Angle::degrees(kTiltPerHeight_deg * moved.y);  // moving down tilts towards looking straight down
  if (!turn.orbit) {
    const Angle highest = highest_pitch(body(), turn.start.eye.height_m, turn.start.fov_y);
    camera_.pitch = std::clamp(turn.start.pitch - tilted, Angle::degrees(-90.0), std::max(highest, turn.start.pitch));
    camera_.heading = Angle::radians(std::remainder((turn.start.heading + turned).rad(), Angle::degrees(360.0).rad()));
    return;
  }
  Orbit orbit = *turn.orbit;
  const Angle lowest = std::min(orbit.depression, Angle::degrees(kLowestDepression_deg));
  orbit.depression = std::clamp(orbit.depression + tilted, lowest, Angle::degrees(90.0));
  orbit.azimuth = orbit.azimuth + turned;
  const Camera camera = orbit_camera(over_ground(orbit, turn.start.fov_y), body(), turn.start.fov_y);
  if (camera.eye.height_m >= std::min(lowest_m(camera.eye), turn.start.eye.height_m)) camera_ = camera;
}

// --- the ground

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

// --- how each motion goes on

Navigator::Motion Navigator::go_on(Rest rest, Seconds) { return rest; }
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
