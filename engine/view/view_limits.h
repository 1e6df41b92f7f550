#pragma once

#include "geo/camera.h"

namespace terrella {

/// Range of the eye's height in navigation: 1 m to 50 equatorial radii. The functions of this header are pure.
/// thread: any
struct HeightRange {
  double lowest_m, highest_m;
  [[nodiscard]] double clamp(double height_m) const;  ///< NaN gives lowest_m
};
[[nodiscard]] HeightRange height_range(const Ellipsoid& ellipsoid);

/// Returns the highest pitch that keeps the horizon well inside the picture. Near the ground the sky is visible at this
/// pitch. Far out the globe stays in view.
[[nodiscard]] Angle highest_pitch(const Ellipsoid& ellipsoid, double height_m, Angle fov_y);

/// Returns the height from which the whole globe fills most of the picture's shorter side, looking straight down.
[[nodiscard]] double whole_globe_height_m(const Ellipsoid& ellipsoid, Angle fov_y, Viewport viewport);

}  // namespace terrella
