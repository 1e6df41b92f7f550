#pragma once

#include "base/result.h"
#include "geo/camera.h"
#include "geo/coordinates.h"
#include "geo/ellipsoid.h"

// thread: any, for all of this header
namespace terrella {

// Checks of a caller's values. Each error names the first value that is out of the range that its header states.

/// Largest distance of a place from the ellipsoid, metres, on either side.
inline constexpr double kMostHeight_m = 1e12;
[[nodiscard]] Status check_place(const Geodetic& place);
[[nodiscard]] Status check_camera(const Camera& camera);
[[nodiscard]] Status check_viewport(Viewport viewport);
[[nodiscard]] Status check_ellipsoid(const Ellipsoid& ellipsoid);

}  // namespace terrella
