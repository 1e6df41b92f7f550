#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "sky/atmosphere.h"

namespace terrella {

[[nodiscard]] constexpr double squared(double x) { return x * x; }

/// An atmosphere over a planet of radius 1: its densities, and tables of values that take long to compute. Heights,
/// radii and lengths are in the planet's radii; cosines are to the local vertical. Light is for a Sun of irradiance 1.
///
/// E. Bruneton, "Precomputed atmospheric scattering: a new implementation" (2017), has the table of transmittance. S.
/// Hillaire, "A scalable and production ready sky and atmosphere rendering technique" (2020), has the table of light
/// that is scattered more than once. After the second time, light is taken as equal from all sides. A table is made in
/// about 40 ms. Values are within 1 % of the integrals. thread: any, for all of this class
class AirTables {
 public:
  AirTables(const Atmosphere& air, double planet_radius_m);

  /// Scattering and extinction per radius of length.
  struct Density {
    glm::vec3 gas, dust, extinct;
  };
  [[nodiscard]] Density density(double height) const;
  [[nodiscard]] double top() const { return top_; }  ///< radius of the end of the air
  [[nodiscard]] const Atmosphere& air() const { return air_; }

  /// Fraction of light that passes from the end of the air to a point, as if there were no ground.
  [[nodiscard]] glm::vec3 transmittance(double radius, double cosine) const;
  /// Sunlight at a point: transmittance times the part of the Sun's disc that the ground leaves.
  [[nodiscard]] glm::vec3 sunlight(double radius, double cosine) const;
  /// Light scattered more than once that reaches a point, as a mean over all directions.
  [[nodiscard]] glm::vec3 skylight(double radius, double cosine) const;
  /// Fraction of light that passes the whole air straight up.
  [[nodiscard]] glm::vec3 vertical() const { return transmittance(1.0, 1.0); }

 private:
  struct RayStep;
  [[nodiscard]] glm::vec3 integrate_transmittance(double radius, double cosine) const;
  [[nodiscard]] std::vector<RayStep> walk(double radius, double cosine) const;
  void make_transmittance();
  void make_skylight();
  void make_skylight_row(int row);

  Atmosphere air_;
  double radius_m_, top_, farthest_;
  glm::vec3 gas_, dust_, dust_extinct_, ozone_;  // per radius of length
  float gas_scale_m_, dust_scale_m_, ozone_height_m_, ozone_half_width_m_;
  std::vector<glm::vec3> transmittance_, skylight_;
};

}  // namespace terrella
