#pragma once

#include <glm/vec3.hpp>
#include <optional>

#include "geo/body.h"

namespace terrella {

/// Gas, dust and ozone over a planet. The densities of gas and dust fall exponentially with height. Ozone is a layer
/// whose density falls to both sides linearly. Coefficients are per metre, for red, green and blue: of gas and dust at
/// height 0, of ozone in the middle of its layer.
struct Atmosphere {
  glm::dvec3 gas_scatter_per_m;  ///< Rayleigh: scattered as 3/(16π) (1 + cos²)
  double gas_scale_m;
  glm::dvec3 dust_scatter_per_m;  ///< Mie: scattered forward
  glm::dvec3 dust_extinct_per_m;
  double dust_scale_m;
  glm::dvec3 dust_forwardness;  ///< g of Cornette and Shanks' phase function
  glm::dvec3 ozone_absorb_per_m;
  double ozone_height_m;      ///< middle of the layer
  double ozone_half_width_m;  ///< from the middle to the edge of the layer
  double top_m;               ///< there is no air above this height
  double exposure;            ///< factor of the radiance before 1 - exp(-x), for a Sun of irradiance 1
};

/// Returns the atmosphere of Earth (also "sphere"), Mars, Titan or Venus; nothing for other bodies, which are drawn
/// without air. thread: any
[[nodiscard]] std::optional<Atmosphere> atmosphere_of(const Body& body);

/// Reflected part of the light that reaches the ground, for the light that the ground throws back into the air.
inline constexpr double kGroundAlbedo = 0.2;

/// Returns the visible fraction of the stars' light, 0...1: 0 by day, 1 at night and far above the air. Fades while the
/// Sun is 4° to 14° under the horizontal, around nautical twilight. thread: any
[[nodiscard]] double star_visibility(const Atmosphere& air, double eye_height_m, double sun_cos);

}  // namespace terrella
