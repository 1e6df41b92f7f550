#pragma once

#include <glm/vec2.hpp>

#include "geo/camera.h"
#include "view/ground.h"

namespace terrella {

/// What a cursor holds on to.
struct Grab {
  Ecef point;               ///< under the cursor; beside the globe a point past the limb (see grab())
  bool on_surface = false;  ///< the cursor's ray really meets the body there
};

/// The point of the ground under a pixel. Beside the globe the answer goes on continuously over the limb: the angle
/// from the sub-eye point grows with the cursor's distance from the globe's middle, so a drag that leaves the globe
/// keeps turning it, as an arcball does. thread: any
[[nodiscard]] Grab grab(const View& view, const Ground& ground, glm::dvec2 pixel_px);

/// What becomes of the heading when the eye travels. `keep`: it stays, as far as a solution exists; north stays where
/// it is in the picture, and the eye may go over the pole. `carry`: it is carried along the shortest way (parallel
/// transport), so that nothing swirls around a pole in view.
enum class HeadingRule { keep, carry };

/// `carry` where the eye or the held point is so near a pole, measured against how far the eye sees, that a constant
/// heading would spin the picture. A gesture asks once, when it starts, so that the rule stays for the gesture. thread:
/// any
[[nodiscard]] HeadingRule heading_rule(const Camera& camera, const Ellipsoid& ellipsoid, const Ecef& held);

/// The camera moved at constant height and pitch so that `point`, on the ellipsoid or raised, is seen at `pixel_px`: ≤
/// 0.01 px off wherever the pixel's ray meets the body away from the limb's last pixel. Beyond the limb the point goes
/// where grab() puts it. Never NaN for finite input. thread: any
[[nodiscard]] Camera pin(const Camera& camera, const Ellipsoid& ellipsoid, Viewport viewport, const Ecef& point,
                         glm::dvec2 pixel_px, HeadingRule rule);

}  // namespace terrella
