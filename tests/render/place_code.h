#pragma once

#include <glm/vec2.hpp>
#include <optional>

#include "gl_fixture.h"

namespace terrella::test {

/// Writes places in colours: red and green are the east and north components of the direction relative to a centre,
/// full scale at ±`half_extent` (of the unit sphere). Smooth everywhere, over the poles and the antimeridian too, so
/// that filtering texels filters places.
class PlaceCode {
 public:
  PlaceCode(const TileGrid& grid, const Ellipsoid& ellipsoid, const Geodetic& center, double half_extent);

  [[nodiscard]] Color paint(double lon_deg, double row_deg) const;
  /// The place that a colour says; nothing if it is at the end of the scale.
  [[nodiscard]] std::optional<Ecef> place(const Color& color) const;
  /// Full scale over which the 255 steps are spread, on the unit sphere.
  [[nodiscard]] double half_extent() const { return half_extent_; }

 private:
  TileGrid grid_;
  Ellipsoid ellipsoid_;
  glm::dvec3 east_{0.0}, north_{0.0}, up_{0.0};
  double half_extent_;
};

/// A globe's picture of places, compared with where pick() says that its pixels look.
struct PlaceError {
  double most_px = 0.0;  ///< that 99 of 100 pixels keep; where tile levels meet a texel is two pixels wide
  int pixels = 0;        ///< that could be judged
};
[[nodiscard]] PlaceError place_error(const Picture& picture, const View& view, const Ellipsoid& ellipsoid,
                                     const PlaceCode& code);

}  // namespace terrella::test
