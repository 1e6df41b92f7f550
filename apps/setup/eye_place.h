#pragma once

#include "apps/setup/scene_options.h"
#include "base/result.h"
#include "geo/body.h"
#include "geo/camera.h"

namespace terrella {

/// Checks the ALT of a --camera. Allowed are heights over the inner sphere (without one: over the planet's centre) from
/// which the planet is a pixel wide at least; 50 equatorial radii always are. The error names the range. thread: any
[[nodiscard]] Status check_eye(const SceneOptions& options, const Body& body, Viewport picture);

/// True if the user wants to look from under the ground: the surface is translucent, or there are objects to see.
[[nodiscard]] bool may_be_underground(const SceneOptions& options);

/// Puts an eye that is in the ground, or under ground that hides everything, 1 m over it: within 1 m of the ground from
/// either side always, further down unless `may_be_under`. `ground_m`: height of the ground under the eye over the
/// ellipsoid. thread: any
[[nodiscard]] Camera out_of_ground(Camera camera, double ground_m, bool may_be_under);

/// Says on standard error that `eye` was moved up to `over`, if it was more than 1 m under where it is now.
void tell_of_move(const char* command, const Camera& eye, const Camera& over);

}  // namespace terrella
