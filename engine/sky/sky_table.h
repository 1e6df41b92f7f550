#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "sky/air_tables.h"

namespace terrella {

/// An eye over a planet of radius 1, and the Sun over it.
struct AirEye {
  double radius = 1.0;   ///< distance of the eye from the planet's centre, ≥ 1
  double sun_cos = 1.0;  ///< cosine of the Sun's distance from the eye's zenith
};

/// Light that reaches the eye along a ray, without its phase functions, for a Sun of irradiance 1.
struct AirLight {
  glm::vec3 gas{0.0F}, dust{0.0F};  ///< sunlight scattered once
  glm::vec3 more{0.0F};             ///< light scattered more than once; needs no phase function
};

/// Light with its phase functions. `sun_cos` is the cosine of the angle between the ray and the Sun. thread: any
[[nodiscard]] glm::vec3 radiance(const AirLight& light, const Atmosphere& air, double sun_cos);

/// A ray from the eye: its elevation, and the part of it that is marched. Coordinates along the ray begin at the point
/// that is nearest to the planet's centre, and grow away from the eye.
struct AirRay {
  double sine = 0.0, cosine = 1.0;  ///< sine and cosine of the angle from the zenith
  double eye = 0.0;                 ///< the eye's coordinate
  double begin = 0.0, end = 0.0;    ///< coordinates of both ends of the part in the air
};
/// The part of a ray in the air: to where it meets the ground, or to the end of the air as if there were no ground.
enum class RayEnd { ground, air };
[[nodiscard]] AirRay air_ray(const AirTables& air, const AirEye& eye, double sine, double cosine, RayEnd end);

/// Steps along a ray, in order from the eye. They are alike for all azimuths of the Sun.
struct RaySteps {
  /// The light of a step is computed from its middle.
  struct Step {
    double middle, radius;  ///< coordinate along the ray, distance from the planet's centre
    glm::vec3 gas, dust;    ///< scattering, times the part of the scattered light that reaches the eye
  };
  std::vector<Step> steps;
  glm::vec3 transmitted{1.0F};  ///< from the far end to the eye
};
/// Steps are shortest where the air is densest. thread: any
[[nodiscard]] RaySteps ray_steps(const AirTables& air, const AirEye& eye, const AirRay& ray, int count);

/// Adds up light along a ray. `azimuth_cos` is the cosine of the ray's azimuth from the Sun's. thread: any
[[nodiscard]] AirLight march(const AirTables& air, const AirEye& eye, const AirRay& ray, const RaySteps& steps,
                             double azimuth_cos);

/// The sky over an eye. Columns are azimuths from the Sun, from 0 to half a turn, both ends included. Rows are heights
/// above the horizon. From an eye outside the air, a row is the height of the ray's lowest point, from 0 to the top, by
/// its square root. From inside, a row is the angle above the geometric horizon up to the zenith, by its square root.
struct SkyTable {
  static constexpr int kColumns = 16;
  static constexpr int kRows = 48;
  bool outside = false;
  double horizon_dip_rad = 0.0;        ///< from inside: the angle of the horizon below the horizontal
  std::vector<AirLight> light;         ///< kColumns a row
  std::vector<glm::vec3> transmitted;  ///< fraction of the light from behind that passes, one a row
  /// Light at an azimuth, 0...1, and a row, 0...1; interpolated.
  [[nodiscard]] AirLight at(double azimuth, double row) const;
};

/// Computes the table, in about 1 ms. thread: any
[[nodiscard]] SkyTable make_sky_table(const AirTables& air, const AirEye& eye);

}  // namespace terrella
