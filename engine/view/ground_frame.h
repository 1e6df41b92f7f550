#pragma once

#include <glm/gtc/quaternion.hpp>

#include "geo/camera.h"

namespace terrella {

/// The eye's vertical and heading as directions. Unlike latitude and longitude, they are not singular at a pole. The
/// functions of this header are pure. thread: any
struct GroundFrame {
  glm::dvec3 up;     ///< geodetic normal at the eye, unit, ECEF axes
  glm::dvec3 ahead;  ///< horizontal direction of the heading, unit, ECEF axes
};

[[nodiscard]] GroundFrame ground_frame(const Camera& camera);
/// Returns `camera` with the latitude, longitude and heading of the frame. The frame need not be exactly orthonormal.
/// The heading is in (-180°, 180°]. On a pole the longitude is 0 and the heading counts from that meridian.
[[nodiscard]] Camera with_frame(const Camera& camera, const GroundFrame& frame);

[[nodiscard]] GroundFrame turned(const GroundFrame& frame, const glm::dquat& turn);
/// Returns the rotation from the body's axes to (ahead, left, up).
[[nodiscard]] glm::dquat orientation(const GroundFrame& frame);
[[nodiscard]] GroundFrame frame_of(const glm::dquat& orientation);

/// Unit vectors to the east and north at a geodetic normal. At a pole they are those of the meridian of longitude 0.
struct EastNorth {
  glm::dvec3 east, north;
};
[[nodiscard]] EastNorth east_north(const glm::dvec3& normal);

}  // namespace terrella
