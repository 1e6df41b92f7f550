#pragma once

#include <glm/gtc/quaternion.hpp>

#include "geo/camera.h"

namespace terrella {

/// The eye's vertical and heading as directions, without latitude and longitude, which are singular at a pole.
struct GroundFrame {
  glm::dvec3 up;     ///< geodetic normal at the eye, unit, ECEF axes
  glm::dvec3 ahead;  ///< horizontal, where the heading points, unit, ECEF axes
};

[[nodiscard]] GroundFrame ground_frame(const Camera& camera);
/// `camera` with the latitude, longitude and heading of the frame, which need not be exactly orthonormal.
/// Heading in (-180°, 180°]; on a pole the longitude is 0 and the heading counts from that meridian.
[[nodiscard]] Camera with_frame(const Camera& camera, const GroundFrame& frame);

[[nodiscard]] GroundFrame turned(const GroundFrame& frame, const glm::dquat& turn);
/// The rotation from the body's axes to (ahead, left, up).
[[nodiscard]] glm::dquat orientation(const GroundFrame& frame);
[[nodiscard]] GroundFrame frame_of(const glm::dquat& orientation);

/// Unit vectors to the east and north at a geodetic normal; at a pole those of the meridian of longitude 0.
struct EastNorth {
  glm::dvec3 east, north;
};
[[nodiscard]] EastNorth east_north(const glm::dvec3& normal);

}  // namespace terrella
