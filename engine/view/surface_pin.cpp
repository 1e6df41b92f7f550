#include "view/surface_pin.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "view/ground_frame.h"

#include "geo/scaled_space.h"

namespace terrella {
namespace {

constexpr double kPi = std::numbers::pi;
// nearer to a pole than this fraction of the angle to the horizon, the heading is carried
constexpr double kPoleShare = 0.35;
constexpr double kFarthest_rad = 2.6;     // short of the antipode, at which the direction past the limb is undefined
constexpr int kIterations = 24;           // each iteration shrinks the error at least by the flattening
constexpr double kConverged_rad = 1e-14;  // 0.1 µm on Earth

glm::dquat shortest_turn(const glm::dvec3& from, const glm::dvec3& to) {
  const glm::dvec3 axis = glm::cross(from, to);
  const double sine = glm::length(axis);
  if (!(sine > 0.0)) return glm::dquat(1.0, 0.0, 0.0, 0.0);
  return glm::angleAxis(std::atan2(sine, glm::dot(from, to)), axis / sine);
}

/// Returns the point at which the ray passes the body, computed in scaled space, so that the point joins the limb
/// without a step whatever the flattening.
glm::dvec3 past_the_limb(const View& view, const Ellipsoid& ellipsoid, const glm::dvec3& ray) {
  const glm::dvec3 axes = semi_axes_m(ellipsoid);
  const glm::dvec3 eye = view.eye.xyz_m / axes;
  const double distance = glm::length(eye);
  const glm::dvec3 out = eye / distance;
  const glm::dvec3 along = glm::normalize(ray / axes);
  const double nadir_rad = std::acos(std::clamp(-glm::dot(along, out), -1.0, 1.0));
  const glm::dvec3 sideways = along - out * glm::dot(along, out);
  const double sideways_length = glm::length(sideways);
  if (!(sideways_length > 0.0) || !(distance > 1.0)) return out * axes;
  const double limb_nadir_rad = std::asin(1.0 / distance);
  const double limb_rad = std::acos(1.0 / distance);
  const double past_rad = limb_rad * (nadir_rad / limb_nadir_rad - 1.0);
  const double room_rad = kFarthest_rad - limb_rad;
  const double turn = limb_rad + room_rad * (1.0 - std::exp(-past_rad / room_rad));
  return (out * std::cos(turn) + sideways / sideways_length * std::sin(turn)) * axes;
}

/// Returns the turn about the held point's direction that restores the frame's heading to `heading`. It makes `east`,
/// the direction that is east if the heading is right, perpendicular to the body's axis. z·east(φ) = c + a cos φ + b
/// sin φ. If no turn does that (the point is nearer to the axis than the picture allows), the result is the turn that
/// comes closest. The two cases meet continuously.
glm::dquat heading_turn(const GroundFrame& frame, Angle heading, const glm::dvec3& held) {
  const glm::dvec3 right = glm::cross(frame.ahead, frame.up);
  const glm::dvec3 east = frame.ahead * std::sin(heading.rad()) + right * std::cos(heading.rad());
  const double c = held.z * glm::dot(held, east);
  const double a = east.z - c;
  const double b = glm::cross(held, east).z;
  const double amplitude = std::hypot(a, b);
  if (!(amplitude > 0.0)) return glm::dquat(1.0, 0.0, 0.0, 0.0);
  const double middle = std::atan2(b, a);
  const double half = std::acos(std::clamp(-c / amplitude, -1.0, 1.0));
  const double one = std::remainder(middle + half, 2.0 * kPi);
  const double other = std::remainder(middle - half, 2.0 * kPi);
  return glm::angleAxis(std::abs(one) < std::abs(other) ? one : other, held);
}

/// Centre of the sphere that fits the ellipsoid at the eye's foot. A rotation about this centre moves the eye along the
/// surface.
glm::dvec3 turning_centre(const Ellipsoid& ellipsoid, const glm::dvec3& up) {
  return ellipsoid.position(EcefDir{up}).xyz_m - up * ellipsoid.prime_vertical_radius_m(up.z);
}

/// The body, enlarged so that its surface contains the point.
Ellipsoid ellipsoid_through(const Ellipsoid& body, const Ecef& point) {
  constexpr double kOnSurface = 1e-12;
  const double scale = glm::length(point.xyz_m / glm::dvec3(body.a_m(), body.a_m(), body.b_m()));
  if (!(scale > 0.0) || std::abs(scale - 1.0) < kOnSurface) return body;
  return Ellipsoid(scale * body.a_m(), body.f());
}

}  // namespace

Grab grab(const View& view, const Ground& ground, glm::dvec2 pixel_px) {
  const EcefDir ray = pixel_ray(view, pixel_px);
  if (const auto distance_m = ground.intersect_m(view.eye, ray, 1.0 / view.pixels_per_radian())) {
    return {Ecef{view.eye.xyz_m + ray.xyz * *distance_m}, true};
  }
  return {Ecef{past_the_limb(view, ground.ellipsoid(), ray.xyz)}, false};
}

HeadingRule heading_rule(const Camera& camera, const Ellipsoid& ellipsoid, const Ecef& held) {
  const double height_m = std::max(camera.eye.height_m, 0.0);
  const double near_pole_rad = kPoleShare * std::acos(ellipsoid.a_m() / (ellipsoid.a_m() + height_m));
  const glm::dvec3 eye = ground_frame(camera).up;
  const glm::dvec3 point = ellipsoid.surface_normal(held).xyz;
  const double eye_rad = std::atan2(std::hypot(eye.x, eye.y), std::abs(eye.z));
  const double point_rad = std::atan2(std::hypot(point.x, point.y), std::abs(point.z));
  return std::min(eye_rad, point_rad) > near_pole_rad ? HeadingRule::keep : HeadingRule::carry;
}

Camera pin(const Camera& camera, const Ellipsoid& ellipsoid, Viewport viewport, const Ecef& point, glm::dvec2 pixel_px,
           HeadingRule rule) {
  GroundFrame frame = ground_frame(camera);
  Camera moved = camera;
  const Ellipsoid surface = ellipsoid_through(ellipsoid, point);
  for (int i = 0; i < kIterations; ++i) {
    const Grab now = grab(make_view(moved, ellipsoid, viewport), surface, pixel_px);
    const glm::dvec3 centre = turning_centre(ellipsoid, frame.up);
    const glm::dvec3 from = glm::normalize(now.point.xyz_m - centre);
    const glm::dvec3 to = glm::normalize(point.xyz_m - centre);
    frame = turned(frame, shortest_turn(from, to));
    if (rule == HeadingRule::keep) frame = turned(frame, heading_turn(frame, camera.heading, to));
    moved = with_frame(camera, frame);
    if (glm::distance(from, to) < kConverged_rad) break;
  }
  return moved;
}

}  // namespace terrella
