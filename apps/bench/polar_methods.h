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

namespace terrella::bench {

/// A way of texturing with its parameters: of paper 1's sphere, or of the engine's globe.
struct PolarMethod {
  std::string name;                 ///< "sphere: plain", "globe: auto" …
  std::optional<PaperLook> sphere;  ///< none: the globe
  Texturing texturing = Texturing::automatic;
  bool squeezed = true;         ///< takes squeezed tiles near the poles, else those of the full grid
  double a = 4.0, band = 0.05;  ///< of the methods that have them
  bool has_a_and_band = false, has_anisotropy = false;
  bool everywhere = true;  ///< in all views, not only where parameters are swept
};

/// The engine's `vertex` is there under this name, the plain sphere under the other: what others are ratios to.
inline constexpr const char* kPlainSphere = "sphere: plain";
inline constexpr const char* kVertexGlobe = "globe: vertex";
inline constexpr const char* kAutoGlobe = "globe: auto";

/// normal: a, b and anisotropy are varied one by one; full: all of a with all of b, in every view.
[[nodiscard]] std::vector<PolarMethod> polar_methods(Effort effort);

}  // namespace terrella::bench
