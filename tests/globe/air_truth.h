#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "geo/camera.h"
#include "sky/atmosphere.h"

namespace terrella::test {

/// The truth about air: rays marched in double through the same densities, over the ellipsoid itself. Nothing else is
/// taken from the engine.
///
/// Single scattering: 80 steps along a ray, each with the depth towards the Sun from 24 steps, and the visible part of
/// the Sun's disc. Multiple scattering: at a place, the light of second order comes from 48 rays of 24 steps around the
/// place, and from the ground that they meet. Higher orders are a geometric series of the part that is scattered again.
/// From the second order on, light is scattered evenly to all sides. The mean over all directions is computed on a grid
/// of heights and Sun's elevations.
class AirTruth {
 public:
  AirTruth(const Atmosphere& air, const Ellipsoid& body);

  /// The colour that an eye sees along a ray, as stored, 0...255: sky on black, or ground of that stored grey. The
  /// ground has the globe's soft light of the Sun, and beside the terminator the colour of the light on it.
  [[nodiscard]] glm::dvec3 color(const glm::dvec3& eye_m, const glm::dvec3& ray, const glm::dvec3& sun,
                                 double ground_srgb) const;
  /// The colour of a thing at a distance, whose own stored colour is `thing_srgb`, as seen from
  /// straight above.
  [[nodiscard]] glm::dvec3 thing(const glm::dvec3& eye_m, const glm::dvec3& ray, double distance_m,
                                 const glm::dvec3& sun, const glm::dvec3& thing_srgb) const;
  /// Factor of a stored colour by the colour of the light on the ground.
  [[nodiscard]] glm::dvec3 ground_tint(const glm::dvec3& place_m, const glm::dvec3& sun) const;

 private:
  struct Seen {
    glm::dvec3 light{0.0}, passed{1.0};
  };
  struct Coefficients {
    glm::dvec3 gas, dust, extinct;
  };
  [[nodiscard]] Coefficients at(double height_m) const;
  [[nodiscard]] double height_m(const glm::dvec3& p) const;
  [[nodiscard]] glm::dvec3 sunlight(const glm::dvec3& p, const glm::dvec3& sun) const;
  [[nodiscard]] glm::dvec3 around(double height_m, double elevation_rad) const;
  [[nodiscard]] glm::dvec3 around_place(const glm::dvec3& p, const glm::dvec3& sun) const;
  [[nodiscard]] Seen march(const glm::dvec3& from, const glm::dvec3& ray, double length_m, const glm::dvec3& sun) const;
  [[nodiscard]] glm::dvec3 vertical(double from_m, double to_m) const;
  /// Stored colour of white ground, 0...1.
  [[nodiscard]] glm::dvec3 ground_light(const glm::dvec3& place_m, const glm::dvec3& sun) const;
  [[nodiscard]] glm::dvec3 light_on_ground(double sun_cos) const;
  [[nodiscard]] double sun_cosine(const glm::dvec3& place_m, const glm::dvec3& sun) const;
  [[nodiscard]] glm::dvec3 film(const glm::dvec3& light) const;
  void make_around();

  Atmosphere air_;
  Ellipsoid body_;
  std::vector<glm::dvec3> around_;
};

}  // namespace terrella::test
