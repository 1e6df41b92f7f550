#pragma once

#include <cstdint>

#include "apps/bench/truth/picture.h"

namespace terrella::truth {

/// A planet of isotropic noise: the hardest honest picture for a renderer, without a direction or a place that it could
/// favour. Three-dimensional value noise, six octaves, is evaluated at the unit vector of each texel's centre, so it is
/// as isotropic at the poles as at the equator; the finest octave's lattice is two texels wide at the equator of *this*
/// size, so a smaller planet is smoother on the ground and the same in texels. Channels are independent.
///
/// Calibration: the plain sphere of paper 1 (apps/bench/baseline/paper_sphere.h, trilinear), 1024×1024, eye at four
/// radii from the centre, field of view 40° (the disc's radius is 0.71 of half the picture), differs from the ray
/// caster by RMS 10.1 in the pole band seen from over the pole, and by 3.4 to 3.8 at latitudes under 60° seen from over
/// 0° and 45°.
struct NoisePlanetOptions {
  int width = 8192;
  int height = 4096;
  std::uint32_t seed = 20230;
  int threads = 2;  ///< the result does not depend on it
};

/// Equirectangular, latitude +90° at the top edge, longitude -180° at the left edge. Deterministic.
[[nodiscard]] Picture noise_planet(const NoisePlanetOptions& options);

}  // namespace terrella::truth
