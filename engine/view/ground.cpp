#include "view/ground.h"

namespace terrella {

double Ground::height_m(Angle lat, Angle lon) const { return heights_ ? heights_->height_m(lat, lon) : 0.0; }

std::optional<double> Ground::intersect_m(const Ecef& origin, const EcefDir& direction, double radians_per_px) const {
  if (!heights_) return ellipsoid_.intersect_m(origin, direction);
  return heights_->intersect_m(origin, direction, radians_per_px);
}

std::optional<Geodetic> pick(const View& view, const Ground& ground, glm::dvec2 pixel_px) {
  const EcefDir ray = pixel_ray(view, pixel_px);
  const auto distance_m = ground.intersect_m(view.eye, ray, 1.0 / view.pixels_per_radian());
  if (!distance_m) return std::nullopt;
  return ground.ellipsoid().to_geodetic(Ecef{view.eye.xyz_m + *distance_m * ray.xyz});
}

std::optional<glm::dvec2> project(const View& view, const Ground& ground, Angle lat, Angle lon) {
  return project(view, ground.ellipsoid().to_ecef({.lat = lat, .lon = lon, .height_m = ground.height_m(lat, lon)}));
}

}  // namespace terrella
