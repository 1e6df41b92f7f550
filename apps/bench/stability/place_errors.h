#pragma once

#include "apps/bench/stability/patch_probe.h"

namespace terrella::bench {

/// Texturing errors of a picture's pixels. The truth is the ray through the pixel's middle, in double. Pixels within
/// 1.5 pixels of the limb, where the surface is seen edge-on, are skipped.
struct PlaceErrors {
  double interpolated_texels = 0.0;  ///< error of patches that the engine draws with interpolation
  double exact_texels = 0.0;         ///< error of per-fragment coordinates, on all patches
  double drawn_px = 0.0;             ///< screen error of the engine's drawing
  int holes = 0;                     ///< pixels of the globe without a drawn patch
  int judged = 0;
};

/// Draws the scene and measures the errors. thread: main (of the context)
[[nodiscard]] PlaceErrors place_errors(PatchScene& scene, PatchProbe& probe);

}  // namespace terrella::bench
