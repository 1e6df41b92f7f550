#pragma once

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <optional>
#include <vector>

#include "geo/body.h"

namespace terrella {

/// Gas and dust over a planet. The density of each falls exponentially with height. Coefficients are per metre at
/// height 0, for red, green and blue.
struct Atmosphere {
  glm::dvec3 gas_scatter_per_m;  ///< Rayleigh: scattered as 3/(16π) (1 + cos²)
  double gas_scale_m;
  glm::dvec3 dust_scatter_per_m;  ///< Mie: scattered forward
  glm::dvec3 dust_extinct_per_m;
  double dust_scale_m;
  double dust_forwardness;  ///< g of Cornette and Shanks' phase function
  /// Optical depth of a thin layer, straight up; the layer absorbs light on its way from the Sun.
  glm::dvec3 ozone_depth;
  double ozone_height_m;  ///< height of that layer
  double top_m;           ///< nothing is drawn above this height
  double exposure;        ///< factor of the radiance before 1 - exp(-x)
};

/// Returns the atmosphere of Earth (also "sphere") or Mars; nothing for other bodies, which are drawn without air.
[[nodiscard]] std::optional<Atmosphere> atmosphere_of(const Body& body);

/// An eye's view of an atmosphere over a spherical planet, single scattering. Columns of the table are azimuths from
/// the Sun, from 0 to half a turn, both ends included. Rows are heights above the horizon. From an eye outside the
/// atmosphere, a row is the height of the ray's lowest point, 0 to top, evenly. From inside, a row is the angle above
/// the geometric horizon up to the zenith, by its square root.
struct SkyTable {
  static constexpr int kColumns = 16;
  static constexpr int kRows = 48;
  bool outside = false;
  double horizon_dip_rad = 0.0;        ///< from inside: the angle of the horizon below the horizontal
  std::vector<glm::vec4> gas;          ///< radiance without the phase function, for a Sun of 1; w unused
  std::vector<glm::vec4> dust;         ///< the same for dust
  std::vector<glm::vec4> transmitted;  ///< fraction of the light from behind that passes, 0...1
};

/// Computes the table. `eye_radius` is the distance from the planet's centre in planet's radii; values below 1 count as
/// 1. `sun_cos` is the cosine of the Sun's distance from the zenith. The optical depth towards the Sun is Chapman's
/// function as approximated by Schüler (2012, GPU Pro 3, chapter II.2), within 1 %. Takes about 1 ms. thread: any
[[nodiscard]] SkyTable make_sky_table(const Atmosphere& air, double planet_radius_m, double eye_radius, double sun_cos);

/// Returns the visible fraction of the stars' light, 0...1: 0 by day, 1 at night and far above the air. Fades while the
/// Sun is 4° to 14° under the horizontal, around nautical twilight. thread: any
[[nodiscard]] double star_visibility(const Atmosphere& air, double eye_height_m, double sun_cos);

}  // namespace terrella
