#pragma once

#include <cmath>
#include <cstdint>

// Arithmetic of pixels and longitudes that lookups and ranges of HeightField share. thread: any
namespace terrella {

/// A part of a pixel that is rounding of degrees.
constexpr double kPixelNoise = 1e-6;

[[nodiscard]] inline std::int64_t whole(double value) { return static_cast<std::int64_t>(std::floor(value)); }

/// The number of pixels that an extent of so many pixels touches.
[[nodiscard]] inline std::int64_t pixels_over(double extent_px) {
  return static_cast<std::int64_t>(std::ceil(extent_px - kPixelNoise));
}

/// Longitude in [-180°, 180°).
[[nodiscard]] inline double wrapped_lon_deg(double lon_deg) {
  const double east = std::fmod(lon_deg + 180.0, 360.0);
  return (east < 0.0 ? east + 360.0 : east) - 180.0;
}

}  // namespace terrella
