#pragma once

#include "apps/bench/stability/patch_probe.h"

namespace terrella::bench {

/// How far from their places a picture's pixels are textured. The truth is the ray through the pixel's middle, in
/// double. Within a pixel and a half of the limb, where the surface is seen from its side, nothing is judged.
struct PlaceErrors {
  double interpolated_texels = 0.0;  ///< of patches that the engine draws so
  double exact_texels = 0.0;         ///< of coordinates for each fragment, on all patches
  double drawn_px = 0.0;             ///< of what the engine draws, on the screen
  int holes = 0;                     ///< pixels of the globe where there is none
  int judged = 0;
};

/// Draws the scene. thread: main (of the context)
[[nodiscard]] PlaceErrors place_errors(PatchScene& scene, PatchProbe& probe);

}  // namespace terrella::bench
