#include "geo/ranges.h"

#include <limits>

#include "base/range_check.h"

namespace terrella {
namespace {

constexpr double kRounding_deg = 1e-9;  // error of an angle in radians and back

}  // namespace

Status check_place(const Geodetic& place) {
  return RangeCheck()
      .in("the latitude", place.lat.deg(), -90.0, 90.0, "°", kRounding_deg)
      .finite("the longitude", place.lon.deg())
      .in("the height", place.height_m, -kMostHeight_m, kMostHeight_m, " m")
      .result();
}

Status check_camera(const Camera& camera) {
  return RangeCheck()
      .part("the eye", check_place(camera.eye))
      .finite("the heading", camera.heading.deg())
      .in("the pitch", camera.pitch.deg(), -90.0, 90.0, "°", kRounding_deg)
      .above("the field of view", camera.fov_y.deg(), 0.0, 170.0, "°", kRounding_deg)
      .result();
}

Status check_viewport(Viewport viewport) {
  constexpr double kMost = std::numeric_limits<int>::max();
  return RangeCheck()
      .in("the width of the picture", viewport.width_px, 1.0, kMost, " px")
      .in("the height of the picture", viewport.height_px, 1.0, kMost, " px")
      .result();
}

Status check_ellipsoid(const Ellipsoid& ellipsoid) {
  return RangeCheck()
      .in("the semi-major axis", ellipsoid.a_m(), 1.0, 1e10, " m")
      .that(ellipsoid.f() >= 0.0 && ellipsoid.f() < 0.5, "the flattening is not in [0, 0.5)")
      .result();
}

}  // namespace terrella
