#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/bench/baseline/paper_sphere.h"
#include "apps/bench/benches.h"
#include "apps/bench/truth/picture.h"
#include "globe/globe.h"
#include "render/gl/offscreen.h"

// Paper 1: A. Zuev, "Method of synthesis of a seamless textured sphere for visualization in geoinformation and
// cartographic systems", 2023.

namespace terrella::bench {

/// A texturing method with its parameters, for paper 1's sphere or the engine's globe.
struct PolarMethod {
  std::string name;                 ///< "sphere: plain", "globe: auto" …
  std::optional<PaperLook> sphere;  ///< none: the globe
  Texturing texturing = Texturing::automatic;
  bool squeezed = true;         ///< uses squeezed tiles near the poles, else the full grid
  double a = 4.0, band = 0.05;  ///< used only if has_a_and_band
  bool has_a_and_band = false, has_anisotropy = false;
  bool everywhere = true;  ///< used in all views, not only where parameters are swept
};

/// Names of the methods used as references in ratios: the plain sphere and the engine's `vertex`.
inline constexpr const char* kPlainSphere = "sphere: plain";
inline constexpr const char* kVertexGlobe = "globe: vertex";
inline constexpr const char* kAutoGlobe = "globe: auto";

/// Lists the methods. normal: varies a, b and anisotropy one by one. full: combines all a with all b in every view.
[[nodiscard]] std::vector<PolarMethod> polar_methods(Effort effort);

}  // namespace terrella::bench
