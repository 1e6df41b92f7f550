#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/bench/benches.h"
#include "apps/bench/truth/ray_caster.h"

namespace terrella::bench {

/// A view of the pole, with the same view moved 55° of latitude away, where the planet is seen from as far and at the
/// same slant: what stands at the pole in the one stands at 35° in the other, in the same pixels.
struct PolarView {
  std::string name;
  truth::TruthCamera camera;
  std::optional<truth::TruthCamera> twin;  ///< none: no pole band is in the picture
  bool swept = false;                      ///< all parameters are tried here, in every run
};

/// The sphere that they look at: Earth's mean radius.
[[nodiscard]] truth::Spheroid polar_body();
/// Height over it from which the sphere is inscribed in the picture at a field of view of 40°.
[[nodiscard]] double inscribed_height_m();
[[nodiscard]] std::vector<PolarView> polar_views(Effort effort);

}  // namespace terrella::bench
