#pragma once

#include "geo/camera.h"

namespace terrella {

/// Heights that navigation stays in: 1 m to 50 equatorial radii.
struct HeightRange {
  double lowest_m, highest_m;
  [[nodiscard]] double clamp(double height_m) const;  ///< NaN gives lowest_m
};
[[nodiscard]] HeightRange height_range(const Ellipsoid& ellipsoid);

/// The highest pitch at which the horizon is still well inside the picture: near the ground it lets one see sky, far
/// out it keeps the globe in view.
[[nodiscard]] Angle highest_pitch(const Ellipsoid& ellipsoid, double height_m, Angle fov_y);

/// The height from which the whole globe fills most of the picture's shorter side, looking straight down.
[[nodiscard]] double whole_globe_height_m(const Ellipsoid& ellipsoid, Angle fov_y, Viewport viewport);

}  // namespace terrella
