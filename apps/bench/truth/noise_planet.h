#pragma once

#include <cstdint>

#include "apps/bench/truth/picture.h"

// Paper 1: A. Zuev, "Method of synthesis of a seamless textured sphere for visualization in geoinformation and
// cartographic systems", 2023.

namespace terrella::truth {

/// Options of a planet of isotropic noise: a hard and fair test picture that favours no direction or place. The noise
/// is three-dimensional value noise with six octaves, evaluated at the unit vector of each texel's centre. The noise is
/// therefore as isotropic at the poles as at the equator. The lattice of the finest octave is two texels wide at the
/// equator of *this* size. A smaller planet is smoother on the ground and equal in texels. Channels are independent.
///
/// Calibration: the plain sphere of paper 1 (apps/bench/baseline/paper_sphere.h, trilinear), 1024×1024, eye at
/// four radii from the centre, field of view 40° (the disc's radius is 0.71 of half the picture). Its RMS difference
/// from the ray caster is 10.1 in the pole band seen from over the pole. The difference is 3.4 to 3.8 at latitudes
/// under 60° seen from over 0° and 45°.
struct NoisePlanetOptions {
  int width = 8192;
  int height = 4096;
  std::uint32_t seed = 20230;
  int threads = 2;  ///< the result does not depend on the number
};

/// Creates an equirectangular picture, latitude +90° at the top edge, longitude -180° at the left edge. Deterministic.
[[nodiscard]] Picture noise_planet(const NoisePlanetOptions& options);

}  // namespace terrella::truth
