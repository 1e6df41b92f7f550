#pragma once

#include <glm/vec2.hpp>

#include "geo/camera.h"
#include "view/ground.h"

namespace terrella {

/// The point that a cursor holds.
struct Grab {
  Ecef point;               ///< under the cursor; beside the globe, a point past the limb (see grab())
  bool on_surface = false;  ///< true if the cursor's ray meets the body
};

/// Returns the point of the ground under a pixel. Beside the globe the result continues over the limb: the angle from
/// the sub-eye point grows with the cursor's distance from the globe's middle. So a drag that leaves the globe keeps
/// turning the globe, like an arcball. thread: any
[[nodiscard]] Grab grab(const View& view, const Ground& ground, glm::dvec2 pixel_px);

/// The rule for the heading when the eye travels. `keep`: the heading stays, if a solution exists. North keeps its
/// direction in the picture, and the eye may go over the pole. `carry`: the heading is carried along the shortest way
/// (parallel transport), so that nothing swirls around a pole in view.
enum class HeadingRule { keep, carry };

/// Returns `carry` if the eye or the held point is near a pole, measured against how far the eye sees. A constant
/// heading would then spin the picture. A gesture asks once, when it starts, so that the rule stays for the gesture.
/// thread: any
[[nodiscard]] HeadingRule heading_rule(const Camera& camera, const Ellipsoid& ellipsoid, const Ecef& held);

/// Moves the camera at constant height and pitch so that `point`, on the ellipsoid or raised, appears at `pixel_px`.
/// Error ≤ 0.01 px if the pixel's ray meets the body, except at the last pixel of the limb. Beyond the limb, the point
/// appears where grab() puts it. Never NaN for finite input. thread: any
[[nodiscard]] Camera pin(const Camera& camera, const Ellipsoid& ellipsoid, Viewport viewport, const Ecef& point,
                         glm::dvec2 pixel_px, HeadingRule rule);

}  // namespace terrella
