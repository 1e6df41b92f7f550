#pragma once

#include <glm/vec3.hpp>

#include "geo/ellipsoid.h"

namespace terrella {

/// Scaled space: ECEF divided by these semi-axes, part by part. There the ellipsoid is the unit sphere, straight lines
/// stay straight and what hides what stays so, which makes horizons and limbs circles. Lengths and angles are no longer
/// those of the world. thread: any
[[nodiscard]] inline glm::dvec3 semi_axes_m(const Ellipsoid& e) { return {e.a_m(), e.a_m(), e.b_m()}; }

}  // namespace terrella
