#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/bench/benches.h"
#include "apps/bench/truth/ray_caster.h"

namespace terrella::bench {

/// A view of the pole, and a twin moved by 55° of latitude with the same distance and slant. Ground at the pole in the
/// view covers the same pixels as ground at 35° in the twin.
struct PolarView {
  std::string name;
  truth::TruthCamera camera;
  std::optional<truth::TruthCamera> twin;  ///< none: the picture contains no pole band
  bool swept = false;                      ///< all parameters are tried in this view, in every run
};

/// The sphere in these views: Earth's mean radius.
[[nodiscard]] truth::Spheroid polar_body();
/// Height above the sphere at which the sphere is inscribed in a picture with a 40° field of view.
[[nodiscard]] double inscribed_height_m();
[[nodiscard]] std::vector<PolarView> polar_views(Effort effort);

}  // namespace terrella::bench
