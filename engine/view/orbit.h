#pragma once

#include "geo/camera.h"

// thread: any, for all of this header
namespace terrella {

/// An eye that looks at a fixed point, and can be tilted and turned around that point. The functions of this header are
/// pure. thread: any
struct Orbit {
  Ecef pivot;         ///< on the surface, seen at the picture's centre
  Angle azimuth;      ///< direction of the line of sight at the pivot, clockwise from north
  Angle depression;   ///< angle of the line of sight below the pivot's horizontal: 90° looks straight down
  double distance_m;  ///< from the eye to the pivot
};

/// Returns the orbit of a camera that looks at `pivot`, a point under the centre of its picture.
[[nodiscard]] Orbit orbit_around(const Camera& camera, const Ellipsoid& ellipsoid, const Ecef& pivot);

/// Returns the camera of an orbit. The camera looks exactly at the pivot, without roll against the eye's own vertical.
[[nodiscard]] Camera orbit_camera(const Orbit& orbit, const Ellipsoid& ellipsoid, Angle fov_y);

}  // namespace terrella
