#pragma once

#include <memory>
#include <optional>
#include <utility>

#include "geo/camera.h"
#include "geo/coordinates.h"
#include "geo/ellipsoid.h"

namespace terrella {

/// Heights over an ellipsoid as they are drawn: exaggerated, from the tiles that are loaded at the call. Relief
/// implements this interface. thread: main
class GroundHeights {
 public:
  virtual ~GroundHeights() = default;
  /// Height over the ellipsoid, metres.
  [[nodiscard]] virtual double height_m(Angle lat, Angle lon) const = 0;
  /// Distance along a ray to the ground, metres, as Ground::intersect_m() promises.
  [[nodiscard]] virtual std::optional<double> intersect_m(const Ecef& origin, const EcefDir& direction,
                                                          double radians_per_px) const = 0;
};

/// The surface of a body as it is drawn: an ellipsoid, raised by heights if there are any. ECEF metres, double. A value
/// that shares the heights: it stays valid when the globe changes or drops its elevation, and then keeps the heights
/// that it had. thread: main with heights, any without
class Ground {
 public:
  Ground(const Ellipsoid& ellipsoid, std::shared_ptr<const GroundHeights> heights = {})
      : ellipsoid_(ellipsoid), heights_(std::move(heights)) {}

  [[nodiscard]] const Ellipsoid& ellipsoid() const { return ellipsoid_; }
  [[nodiscard]] bool has_relief() const { return heights_ != nullptr; }
  /// Over the ellipsoid, metres; 0 without relief.
  [[nodiscard]] double height_m(Angle lat, Angle lon) const;
  /// Of the eye over the ground under it, metres; negative under the ground.
  [[nodiscard]] double height_over_m(const Geodetic& place) const {
    return place.height_m - height_m(place.lat, place.lon);
  }

  /// Distance along a ray from `origin` to where it first goes through the ground, from either side, metres; nothing if
  /// it does not. Without relief Ellipsoid::intersect_m(). With it the ray is followed through the heights between
  /// which all ground lies, in steps of half a height's spacing or of `radians_per_px` of the distance, whichever is
  /// longer, and the step that goes through is halved until it is right to 1 part in 10^12 or a tenth of a millimetre.
  /// Ground that is thinner along the ray than a step may be missed.
  [[nodiscard]] std::optional<double> intersect_m(const Ecef& origin, const EcefDir& direction,
                                                  double radians_per_px = 1e-3) const;

 private:
  Ellipsoid ellipsoid_;
  std::shared_ptr<const GroundHeights> heights_;
};

/// The place that a pixel shows (frame and centres as in geo/coordinates.h): latitude and longitude and the height at
/// which the line of sight goes through the ground, metres over the ellipsoid, as far as Ground::intersect_m()
/// promises. Nothing beside the globe. By the heights themselves, not by what was drawn: right to a tenth of a pixel at
/// any distance, also at poles, on ±180° and where the ground is grazed. thread: as Ground's
[[nodiscard]] std::optional<Geodetic> pick(const View& view, const Ground& ground, glm::dvec2 pixel_px);
/// The way back: the pixel position of the ground at a place, whether something stands before it or not; nothing if it
/// is at or behind the eye's plane. Where pick() finds a place, its pixel: the two differ by under 0.1 px, cliffs
/// between tiles of different levels aside.
[[nodiscard]] std::optional<glm::dvec2> project(const View& view, const Ground& ground, Angle lat, Angle lon);

}  // namespace terrella
