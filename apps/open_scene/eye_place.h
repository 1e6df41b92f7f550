#pragma once

#include "apps/open_scene/options/scene_options.h"
#include "base/result.h"
#include "geo/body.h"
#include "geo/camera.h"

namespace terrella {

/// Checks the ALT of --camera. The eye must be above the inner sphere, or above the planet's centre without one. The
/// planet must be at least a pixel wide; 50 equatorial radii are always allowed. The error names the range. thread: any
[[nodiscard]] Status check_eye(const SceneOptions& options, const Body& body, Viewport picture);

/// True if the eye may be under the ground: the surface is translucent, or the scene has objects.
[[nodiscard]] bool may_be_underground(const SceneOptions& options);

/// Moves an eye in the ground, or under opaque ground, to 1 m above the ground. An eye within 1 m of the ground on
/// either side always moves. An eye further down moves unless `may_be_under`. `ground_m` is the ground's height under
/// the eye over the ellipsoid. thread: any
[[nodiscard]] Camera out_of_ground(Camera camera, double ground_m, bool may_be_under);

/// Reports on standard error that `eye` moved up to `over`, if the move was more than 1 m.
void tell_of_move(const char* command, const Camera& eye, const Camera& over);

}  // namespace terrella
