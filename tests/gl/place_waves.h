#pragma once

#include <array>
#include <glm/vec2.hpp>

#include "tests/gl/gl_fixture.h"

namespace terrella::test {

/// Writes places in colours: each channel is a sine of the surface normal's part along a direction of its own, the
/// three directions a third of a turn apart around a centre and the three periods not multiples of each other.
/// Averaging texels dims a sine and does not move it, so that a picture of waves says where it is drawn to a few
/// hundredths of a pixel whatever filters it; and a shift by a period of one channel shows in the others.
class PlaceWaves {
 public:
  /// `pixel` is what a pixel in the middle of the picture spans on the unit sphere.
  PlaceWaves(const TileGrid& grid, const Ellipsoid& ellipsoid, const Geodetic& center, double pixel);

  [[nodiscard]] Color paint(double lon_deg, double row_deg) const;
  /// The channels at a place, not rounded.
  [[nodiscard]] std::array<double, 3> levels(const EcefDir& normal) const;

 private:
  TileGrid grid_;
  Ellipsoid ellipsoid_;
  std::array<glm::dvec3, 3> wave_{};  ///< radians of phase per unit of the normal
  glm::dvec3 up_{0.0};
};

/// A picture of waves, compared with where pick() says that its pixels look.
struct WaveError {
  int pixels = 0;        ///< pixels at which the three waves together give a place in both directions
  double most_px = 0.0;  ///< the farthest that a pixel is off
  double usual_px =
      0.0;  ///< offset that 98 of 100 pixels keep: one row of 48 may lie at a change of levels, with texels of two px
  glm::dvec2 mean_px{0.0};  ///< mean offset, right and down: rounding of colours averages out
};
[[nodiscard]] WaveError wave_error(const Picture& picture, const View& view, const Ellipsoid& ellipsoid,
                                   const PlaceWaves& waves);

}  // namespace terrella::test
