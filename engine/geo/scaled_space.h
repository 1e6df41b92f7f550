#pragma once

#include <glm/vec3.hpp>

#include "geo/ellipsoid.h"

namespace terrella {

/// Semi-axes of the ellipsoid. ECEF divided by these, component by component, is scaled space. There the ellipsoid is
/// the unit sphere, and horizons and limbs are circles. Straight lines stay straight, and occlusion stays the same.
/// Lengths and angles are not preserved. thread: any
[[nodiscard]] inline glm::dvec3 semi_axes_m(const Ellipsoid& e) { return {e.a_m(), e.a_m(), e.b_m()}; }

}  // namespace terrella
