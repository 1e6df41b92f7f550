#pragma once

#include "geo/camera.h"
#include "geo/ellipsoid.h"
#include "view/ground.h"
#include "view/render_modes.h"

namespace terrella {

/// A pair of off-axis eyes. Their planes of view are parallel, so nothing is shifted up or down between the pictures,
/// and what lies at the convergence distance appears at the depth of the screen (paper 2, 2.10).
struct EyePair {
  View left, right;
  View both;  ///< for selection: holds all that either eye sees
  double convergence_m = 0.0;
  double separation_m = 0.0;
};

/// The eyes to either side of a view's eye, each with the view's picture size. They converge on what the picture's
/// middle shows of the ground, or, where that is the sky, at the height over it; unless it is told, they stand a
/// thirtieth of that apart, which keeps the parallax of everything behind the screen under 1/30 of its distance, from
/// orbit to street; over relief never further apart than the eye is high over it. thread: as Ground's
[[nodiscard]] EyePair stereo_eyes(const View& view, const Ground& ground, const StereoLook& look);

}  // namespace terrella
