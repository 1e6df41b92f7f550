#include "view/navigation.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "geo/ranges.h"
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
constexpr double kWheelFactor = 0.8;  // factor of the height per wheel step
constexpr double kKeyFactor = 0.65;
constexpr double kLeastPinch = 0.1;  // smallest factor of one pinch event; a smaller one is a device's error
constexpr double kPanShare = 0.12;   // fraction of the picture's shorter side per key press
constexpr double kFlyFactor = 0.4;   // factor of the height for a double click
constexpr double kTurnPerWidth_deg = 270.0;
constexpr double kTiltPerHeight_deg = 120.0;
constexpr double kLowestDepression_deg = 2.0;

bool finite(glm::dvec2 v) { return std::isfinite(v.x) && std::isfinite(v.y); }
bool finite(Seconds t) { return std::isfinite(t.count()); }

Viewport at_least_one(Viewport viewport) { return {std::max(viewport.width_px, 1), std::max(viewport.height_px, 1)}; }

glm::dvec2 limited(glm::dvec2 speed, double most) {
  const double length = glm::length(speed);
  return length > most ? speed * (most / length) : speed;
}

}  // namespace

Navigator::Navigator(const Camera& camera, const Ground& ground, Viewport viewport)
    : camera_(check_camera(camera) ? camera : Camera{}), ground_(ground), viewport_(at_least_one(viewport)) {}

void Navigator::set_viewport(Viewport viewport) { viewport_ = at_least_one(viewport); }

void Navigator::set_camera(const Camera& camera) {
  if (!check_camera(camera)) return;
  camera_ = camera;
  motion_ = Rest{};
}

void Navigator::lead(const Camera& camera) {
  set_camera(camera);
  motion_ = Led{};
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

void Navigator::double_click(glm::dvec2 at_px, Seconds now) { fly_towards(at_px, kFlyFactor, now); }

void Navigator::centre_on(glm::dvec2 at_px, Seconds now) { fly_towards(at_px, 1.0, now); }

void Navigator::fly_towards(glm::dvec2 at_px, double factor, Seconds now) {
  if (!finite(at_px) || !finite(now)) return;
  advance(now);
  const Grab there = grab_at(at_px);
  if (!there.on_surface) return;
  Camera target = camera_;
  const double base = base_m(there);
  target.eye.height_m = base + nearer_m(camera_.eye.height_m - base, factor);
  target.pitch = std::min(target.pitch, highest_pitch(body(), target.eye.height_m, Angle{}) - Angle::degrees(5.0));
  start_flight(pin(target, body(), viewport_, there.point, centre_px(), heading_rule(camera_, body(), there.point)));
}

void Navigator::wheel(glm::dvec2 at_px, double steps, Seconds now) {
  if (!finite(at_px) || !std::isfinite(steps) || !finite(now)) return;
  advance(now);
  const double factor = std::pow(kWheelFactor, std::clamp(steps, -20.0, 20.0));
  if (Drag* drag = std::get_if<Drag>(&motion_)) {
    const double base = base_m({drag->held, true});
    set_height(base + zoomed_m(camera_.eye.height_m - base, factor, now));
    drag->start = camera_;
    pin_drag(*drag);
  } else if (!std::holds_alternative<Turn>(motion_)) {
    zoom_by(factor, at_px, now);
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
  if (!check_camera(camera) || !finite(now)) return;
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
      return zoom_by(kKeyFactor, {}, now);
    case NavigationKey::zoom_out:
      return zoom_by(1.0 / kKeyFactor, {}, now);
    case NavigationKey::north_up:
      motion_ = TurnNorth{grab_at(centre_px()), camera_.heading};
      return;
    case NavigationKey::whole_globe:
      return go_whole_globe();
    case NavigationKey::look_down:
      return go_look_down();
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

void Navigator::zoom_by(double factor, std::optional<glm::dvec2> at_px, Seconds now) {
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
                 zoomed_m(from_m - base, factor, now)};
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

void Navigator::go_look_down() {
  const Grab centre = grab_at(centre_px());
  Camera target = camera_;
  if (centre.on_surface) {
    Orbit orbit = orbit_around(camera_, body(), centre.point);
    orbit.depression = Angle::degrees(90.0);
    target = orbit_camera(orbit, body(), camera_.fov_y);
  }
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

}  // namespace terrella
