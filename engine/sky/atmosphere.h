#pragma once

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <optional>
#include <vector>

#include "geo/body.h"

namespace terrella {

/// Gas and dust over a planet, each thinning out exponentially. Coefficients per metre at height 0, for red, green,
/// blue.
struct Atmosphere {
  glm::dvec3 gas_scatter_per_m;  ///< Rayleigh: scattered as 3/(16π) (1 + cos²)
  double gas_scale_m;
  glm::dvec3 dust_scatter_per_m;  ///< Mie: scattered forward
  glm::dvec3 dust_extinct_per_m;
  double dust_scale_m;
  double dust_forwardness;  ///< g of Cornette and Shanks' phase function
  glm::dvec3 ozone_depth;   ///< of a thin layer, straight up: it takes light on its way from the Sun
  double ozone_height_m;    ///< of that layer
  double top_m;             ///< nothing is drawn above
  double exposure;          ///< what the radiance is multiplied by before 1 - exp(-x)
};

/// Earth (also "sphere") and Mars have one that is drawn; nothing for other bodies.
[[nodiscard]] std::optional<Atmosphere> atmosphere_of(const Body& body);

/// What an eye sees of an atmosphere over a spherical planet, single scattering: a table over the rows' height above
/// the horizon and the columns' azimuth from the Sun, from 0 to half a turn, both ends included. Rows, from an eye
/// outside the atmosphere: the height of the ray's lowest point, 0 to top, evenly. From inside: the angle above the
/// geometric horizon up to the zenith, by its square root.
struct SkyTable {
  static constexpr int kColumns = 16;
  static constexpr int kRows = 48;
  bool outside = false;
  double horizon_dip_rad = 0.0;        ///< from inside: the horizon lies that far below the horizontal
  std::vector<glm::vec4> gas;          ///< radiance but for the phase function, for a Sun of 1; w unused
  std::vector<glm::vec4> dust;         ///< likewise
  std::vector<glm::vec4> transmitted;  ///< of the light that comes from behind, 0...1
};

/// `eye_radius`: distance from the planet's centre in planet's radii, taken for 1 if it is less; `sun_cos`: cosine of
/// the Sun's distance from the zenith. The optical depth towards the Sun is Chapman's function as Schüler (2012, GPU
/// Pro 3, chapter II.2) approximates it, within 1 %. About a millisecond. thread: any
[[nodiscard]] SkyTable make_sky_table(const Atmosphere& air, double planet_radius_m, double eye_radius, double sun_cos);

/// How much of the stars' light is noticed, 0...1: none by day, all at night and far above the air. Fades while the Sun
/// is 4° to 14° under the horizontal, after nautical twilight. thread: any
[[nodiscard]] double star_visibility(const Atmosphere& air, double eye_height_m, double sun_cos);

}  // namespace terrella
