#include "apps/scene/bounds_view.h"

#include <algorithm>
#include <cmath>

#include "geo/longitudes.h"

namespace terrella {
namespace {

constexpr double kMostOfPlanet_deg = 300.0;
constexpr double kRoom = 1.3;         // visible extent relative to that of the bounds
constexpr double kNearest_m = 100.0;  // lowest height, as a single point has no extent

}  // namespace

Angle width_of(const GeoRect& bounds) { return Angle::degrees(width_deg(bounds)); }

std::optional<GeoRect> if_a_part(const GeoRect& bounds) {
  if (width_of(bounds).deg() > kMostOfPlanet_deg) return {};
  return bounds;
}

Camera camera_over(const GeoRect& bounds, const Ellipsoid& body, Angle fov_y, double aspect) {
  const double lat_deg = 0.5 * (bounds.south.deg() + bounds.north.deg());
  const double high = bounds.north.rad() - bounds.south.rad();
  const double wide = width_of(bounds).rad() * std::cos(Angle::degrees(lat_deg).rad());
  const double span_m = kRoom * body.a_m() * std::max(high, wide / aspect);
  Camera camera;
  camera.fov_y = fov_y;
  camera.eye = {.lat = Angle::degrees(lat_deg), .lon = bounds.west + 0.5 * width_of(bounds)};
  camera.eye.height_m = std::max(kNearest_m, 0.5 * span_m / std::tan(0.5 * fov_y.rad()));
  return camera;
}

}  // namespace terrella
