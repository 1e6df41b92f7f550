#pragma once

#include <memory>
#include <optional>
#include <utility>

#include "geo/camera.h"
#include "geo/coordinates.h"
#include "geo/ellipsoid.h"

namespace terrella {

/// Heights over an ellipsoid as they are drawn: exaggerated, from the tiles that are loaded at the time of the call.
/// Relief implements this interface. thread: main
class GroundHeights {
 public:
  virtual ~GroundHeights() = default;
  /// Height over the ellipsoid, metres.
  [[nodiscard]] virtual double height_m(Angle lat, Angle lon) const = 0;
  /// Distance along a ray to the ground, metres. Ground::intersect_m() states the contract.
  [[nodiscard]] virtual std::optional<double> intersect_m(const Ecef& origin, const EcefDir& direction,
                                                          double radians_per_px) const = 0;
};

/// The drawn surface of a body: an ellipsoid, raised by heights if there are any. ECEF metres, double. This value
/// shares the heights: it stays valid when the globe changes or drops its elevation, and then keeps the heights that it
/// had. thread: main with heights, thread: any without
class Ground {
 public:
  Ground(const Ellipsoid& ellipsoid, std::shared_ptr<const GroundHeights> heights = {})
      : ellipsoid_(ellipsoid), heights_(std::move(heights)) {}

  [[nodiscard]] const Ellipsoid& ellipsoid() const { return ellipsoid_; }
  [[nodiscard]] bool has_relief() const { return heights_ != nullptr; }
  /// Height of the ground over the ellipsoid, metres; 0 without relief.
  [[nodiscard]] double height_m(Angle lat, Angle lon) const;
  /// Height of a place over the ground under it, metres; negative under the ground.
  [[nodiscard]] double height_over_m(const Geodetic& place) const {
    return place.height_m - height_m(place.lat, place.lon);
  }

  /// Returns the distance along a ray from `origin` to its first crossing of the ground, from either side, metres;
  /// nothing if the ray misses. Without relief this is Ellipsoid::intersect_m().
  ///
  /// With relief, the ray is followed between the lowest and the highest ground. A step is half the spacing of the
  /// heights, or `radians_per_px` of the distance, whichever is longer. The step that crosses the ground is halved
  /// until the error is 1 part in 10^12 or 0.1 mm. Ground that is thinner along the ray than one step may be missed.
  [[nodiscard]] std::optional<double> intersect_m(const Ecef& origin, const EcefDir& direction,
                                                  double radians_per_px = 1e-3) const;

 private:
  Ellipsoid ellipsoid_;
  std::shared_ptr<const GroundHeights> heights_;
};

/// Returns the place that a pixel shows, in the pixel frame of geo/coordinates.h: latitude, longitude, and the height
/// over the ellipsoid at which the line of sight crosses the ground, metres. Nothing if the pixel shows no ground. The
/// result uses the heights, not the drawn picture. It is accurate to 0.1 px at any distance, also at poles, on ±180°
/// and at grazing incidence, with the limits of Ground::intersect_m(). thread: main with heights, thread: any without
[[nodiscard]] std::optional<Geodetic> pick(const View& view, const Ground& ground, glm::dvec2 pixel_px);
/// Returns the pixel position of the ground at a place, even if something hides the place; nothing if it is at or
/// behind the eye's plane. For a place from pick(), the result is within 0.1 px of the picked pixel, except at cliffs
/// between tiles of different levels. thread: main with heights, thread: any without
[[nodiscard]] std::optional<glm::dvec2> project(const View& view, const Ground& ground, Angle lat, Angle lon);

}  // namespace terrella
