#pragma once

#include "apps/bench/truth/picture.h"
#include "apps/bench/truth/ray_caster.h"
#include "globe/globe.h"
#include "render/gl/offscreen.h"

namespace terrella::bench {

/// Converts a camera for the engine.
[[nodiscard]] Camera as_globe_camera(const truth::TruthCamera& camera);
/// Converts a camera for the ground truth.
[[nodiscard]] truth::TruthCamera as_truth_camera(const Camera& camera);
[[nodiscard]] truth::Spheroid as_spheroid(const Ellipsoid& ellipsoid);

/// Reads a target's picture without alpha.
[[nodiscard]] truth::Picture shot(const OffscreenTarget& target, Viewport size);

/// Sets the globe's camera and draws until nothing is missing. Throws std::runtime_error after two minutes.
FrameStats settle(Globe& globe, const truth::TruthCamera& camera, const OffscreenTarget& target, Viewport size);

}  // namespace terrella::bench
