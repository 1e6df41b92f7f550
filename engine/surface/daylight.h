#pragma once

#include <glm/vec3.hpp>

#include "geo/ellipsoid.h"
#include "surface/layers.h"
#include "surface/patch_tree.h"

namespace terrella {

/// Sine of the Sun's depth, centre below the horizon, at which civil twilight ends: 6° (Explanatory Supplement to the
/// Astronomical Almanac, 3rd edition, 2013, glossary). Refraction and the Sun's size are left out, as that says.
inline constexpr double kTwilightSine = 0.10452846326765347;

/// Visible part of a layer, [0, 1], by the sine of the Sun's height over the geodetic horizon. A day layer shows fully
/// from 0° up and not at all from -6° down, and a night layer shows the rest. In between the part follows a cubic, as
/// lamplight() in shaders/frame.glsl. thread: any
[[nodiscard]] double part_shown(Daylight side, double sun_sine);

/// False if nothing of a layer shows on a patch. `sun` is a unit vector in ECEF axes. May be true for a patch beside
/// the twilight. thread: any
[[nodiscard]] bool may_show(Daylight side, const PatchNode& patch, const Ellipsoid& ellipsoid, const glm::dvec3& sun);

}  // namespace terrella
