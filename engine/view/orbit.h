#pragma once

#include "geo/camera.h"

// thread: any, for all of this header
namespace terrella {

/// An eye that looks at a fixed point and is tilted and turned around it.
struct Orbit {
  Ecef pivot;         ///< on the surface, seen at the picture's centre
  Angle azimuth;      ///< of the line of sight at the pivot, clockwise from north
  Angle depression;   ///< of the line of sight at the pivot, below its horizontal: 90° looks straight down
  double distance_m;  ///< from the eye to the pivot
};

/// The orbit that a camera is on which looks at `pivot` (a point under the centre of its picture).
[[nodiscard]] Orbit orbit_around(const Camera& camera, const Ellipsoid& ellipsoid, const Ecef& pivot);

/// The camera of an orbit: looks at the pivot exactly, without roll against the eye's own vertical.
[[nodiscard]] Camera orbit_camera(const Orbit& orbit, const Ellipsoid& ellipsoid, Angle fov_y);

}  // namespace terrella
