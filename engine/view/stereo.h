#pragma once

#include "geo/camera.h"
#include "geo/ellipsoid.h"
#include "view/ground.h"
#include "view/render_modes.h"

// Paper 2: "Interactive visualization of 3D data on a virtual globe in stereoscopic systems", abstract of a
// dissertation, chapter 2.2.

namespace terrella {

/// A pair of off-axis eyes. Their view planes are parallel, so the pictures have no vertical parallax. Objects at the
/// convergence distance appear at the depth of the screen (paper 2, 2.10).
struct EyePair {
  View left, right;
  View both;  ///< for selection: contains all that either eye sees
  double convergence_m = 0.0;
  double separation_m = 0.0;
};

/// Returns the eyes to either side of a view's eye, each with the view's picture size. They converge on the ground at
/// the picture's middle. If the sky is there, they converge at the eye's height over the ground. By default their
/// separation is 1/30 of the convergence distance, which keeps the parallax of everything behind the screen under 1/30
/// of its distance, from orbit to street. Over relief the separation is at most the eye's height over the ground.
/// thread: main with heights, thread: any without
[[nodiscard]] EyePair stereo_eyes(const View& view, const Ground& ground, const StereoLook& look);

}  // namespace terrella
