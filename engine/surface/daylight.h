#pragma once

#include <glm/vec3.hpp>

#include "geo/ellipsoid.h"
#include "surface/layers.h"
#include "surface/patch_tree.h"

namespace terrella {

/// Sine of the Sun's depth, centre below the horizon, at which civil twilight ends: 6° (Explanatory Supplement to the
/// Astronomical Almanac, 3rd edition, 2013, glossary). Refraction and the Sun's size are left out, as that says.
inline constexpr double kTwilightSine = 0.10452846326765347;

/// How much of a layer shows, [0, 1], by the sine of the Sun's height over the geodetic horizon: by day all of it from
/// 0° on and nothing from -6° on, by night the rest; between them a cubic without edges at either end, as smoothstep()
/// in shaders/surface/patch_common.glsl. thread: any
[[nodiscard]] double part_shown(Daylight side, double sun_sine);

/// Whether anything of a layer shows on a patch, `sun` being a unit vector in ECEF axes. May be true of a patch beside
/// the twilight. thread: any
[[nodiscard]] bool may_show(Daylight side, const PatchNode& patch, const Ellipsoid& ellipsoid, const glm::dvec3& sun);

}  // namespace terrella
