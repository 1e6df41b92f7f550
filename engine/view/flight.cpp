#include "view/flight.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "view/ground_frame.h"

namespace terrella {
namespace {

constexpr double kLowestFlight_m = 0.1;  // floor of the heights, which are interpolated by their logarithm
constexpr double kClimb = 0.4;           // climb as a fraction of the length of the way

double log_height(double height_m) { return std::log(std::max(height_m, kLowestFlight_m)); }

}  // namespace

double ease_in_out(double x) {
  const double t = std::clamp(x, 0.0, 1.0);
  return t * t * t * (t * (6.0 * t - 15.0) + 10.0);
}

Flight plan_flight(const Camera& from, const Camera& to, const Ellipsoid& ellipsoid) {
  const glm::dvec3 a = ground_frame(from).up;
  const glm::dvec3 b = ground_frame(to).up;
  const double way_m = ellipsoid.a_m() * std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
  const double summit_m = kClimb * way_m;
  const double highest = std::max(log_height(from.eye.height_m), log_height(to.eye.height_m));
  const double climb = std::max(0.0, log_height(summit_m) - highest);
  const double change = std::abs(log_height(from.eye.height_m) - log_height(to.eye.height_m));
  const Seconds duration(std::clamp(0.6 + 0.2 * change + 0.35 * climb, 0.6, 2.5));
  return {from, to, summit_m, duration};
}

Camera flight_camera(const Flight& flight, Seconds since_start) {
  if (since_start <= Seconds(0.0)) return flight.from;
  if (!(since_start < flight.duration)) return flight.to;
  const double s = ease_in_out(since_start / flight.duration);
  const glm::dquat turn = glm::slerp(orientation(ground_frame(flight.from)), orientation(ground_frame(flight.to)), s);
  Camera camera = with_frame(flight.to, frame_of(turn));
  const double from = log_height(flight.from.eye.height_m);
  const double to = log_height(flight.to.eye.height_m);
  const double climb = std::max(0.0, log_height(flight.summit_m) - std::max(from, to));
  camera.eye.height_m = std::exp(from + (to - from) * s + climb * 4.0 * s * (1.0 - s));
  camera.pitch = flight.from.pitch + s * (flight.to.pitch - flight.from.pitch);
  camera.fov_y = flight.from.fov_y + s * (flight.to.fov_y - flight.from.fov_y);
  return camera;
}

}  // namespace terrella
