#include "view/ground_frame.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

namespace terrella {

EastNorth east_north(const glm::dvec3& normal) {
  const double off_axis = std::hypot(normal.x, normal.y);
  const glm::dvec3 east =
      off_axis > 0.0 ? glm::dvec3(-normal.y / off_axis, normal.x / off_axis, 0.0) : glm::dvec3(0.0, 1.0, 0.0);
  return {east, glm::cross(normal, east)};
}

GroundFrame ground_frame(const Camera& camera) {
  const glm::dvec3 up = Ellipsoid::normal(camera.eye.lat, camera.eye.lon).xyz;
  // East follows from the longitude, not from `up`: at a pole the longitude defines the zero of the heading.
  const double lon = camera.eye.lon.rad();
  const glm::dvec3 east(-std::sin(lon), std::cos(lon), 0.0);
  const glm::dvec3 north = glm::cross(up, east);
  return {up, north * std::cos(camera.heading.rad()) + east * std::sin(camera.heading.rad())};
}

Camera with_frame(const Camera& camera, const GroundFrame& frame) {
  const glm::dvec3 up = glm::normalize(frame.up);
  const Geodetic place = Ellipsoid::lat_lon(EcefDir{up});
  Camera moved = camera;
  moved.eye.lat = place.lat;
  moved.eye.lon = place.lon;
  const double lon = place.lon.rad();
  const glm::dvec3 east(-std::sin(lon), std::cos(lon), 0.0);
  const glm::dvec3 north = glm::cross(up, east);
  moved.heading = Angle::radians(std::atan2(glm::dot(frame.ahead, east), glm::dot(frame.ahead, north)));
  return moved;
}

GroundFrame turned(const GroundFrame& frame, const glm::dquat& turn) { return {turn * frame.up, turn * frame.ahead}; }

glm::dquat orientation(const GroundFrame& frame) {
  return glm::normalize(glm::quat_cast(glm::dmat3(frame.ahead, glm::cross(frame.up, frame.ahead), frame.up)));
}

GroundFrame frame_of(const glm::dquat& orientation) {
  return {orientation * glm::dvec3(0.0, 0.0, 1.0), orientation * glm::dvec3(1.0, 0.0, 0.0)};
}

}  // namespace terrella
