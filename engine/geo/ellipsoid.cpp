#include "geo/ellipsoid.h"

#include <GeographicLib/Geocentric.hpp>
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

namespace terrella {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

bool is_finite(const glm::dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

/// Longitude in (-180°, 180°]. atan2 alone would return -180° for y = -0 (or a y that rounds away) and, on the axis,
/// 180° for x = -0.
Angle longitude(double x, double y) {
  if (x == 0.0 && y == 0.0) return Angle{};
  const double lon = std::atan2(y, x);
  return Angle::radians(lon <= -std::numbers::pi ? std::numbers::pi : lon);
}

/// The quadratic A t² - 2 B t + C = 0 of a ray and the unit sphere. The discriminant, a quarter of the textbook's,
/// follows from the ray's closest approach to the centre. B² - A C would lose all its digits for a distant eye.
struct RayQuadratic {
  double a, b, c, discriminant;
};

RayQuadratic ray_quadratic(const glm::dvec3& origin, const glm::dvec3& direction) {
  const double a = glm::dot(direction, direction);
  const double b = -glm::dot(origin, direction);
  const glm::dvec3 closest = origin + (b / a) * direction;
  return {.a = a, .b = b, .c = glm::dot(origin, origin) - 1.0, .discriminant = a * (1.0 - glm::dot(closest, closest))};
}

}  // namespace

double Ellipsoid::prime_vertical_radius_m(double n_z) const { return a_m_ / std::sqrt(1.0 - e2() * n_z * n_z); }

Ecef Ellipsoid::position(const EcefDir& normal, double height_m) const {
  const glm::dvec3& n = normal.xyz;
  const double radius = prime_vertical_radius_m(n.z);
  return Ecef{{(radius + height_m) * n.x, (radius + height_m) * n.y, (radius * one_minus_e2() + height_m) * n.z}};
}

Ecef Ellipsoid::to_ecef(const Geodetic& place) const { return position(normal(place.lat, place.lon), place.height_m); }

Geodetic Ellipsoid::to_geodetic(const Ecef& p) const {
  const bool valid_figure = std::isfinite(a_m_) && a_m_ > 0.0 && f_ >= 0.0 && f_ < 1.0;
  if (!valid_figure || !is_finite(p.xyz_m)) {
    return {.lat = Angle::radians(kNaN), .lon = Angle::radians(kNaN), .height_m = kNaN};
  }
  const GeographicLib::Geocentric geocentric(a_m_, f_);
  double lat_deg = 0.0;
  double lon_deg = 0.0;
  double height_m = 0.0;
  geocentric.Reverse(p.xyz_m.x, p.xyz_m.y, p.xyz_m.z, lat_deg, lon_deg, height_m);
  // The longitude comes straight from the position, which avoids the rounding of a conversion to degrees.
  return {.lat = Angle::degrees(lat_deg), .lon = longitude(p.xyz_m.x, p.xyz_m.y), .height_m = height_m};
}

EcefDir Ellipsoid::normal(Angle lat, Angle lon) {
  const double cos_lat = std::cos(lat.rad());
  return EcefDir{{cos_lat * std::cos(lon.rad()), cos_lat * std::sin(lon.rad()), std::sin(lat.rad())}};
}

Geodetic Ellipsoid::lat_lon(const EcefDir& normal) {
  const glm::dvec3& n = normal.xyz;
  return {.lat = Angle::radians(std::atan2(n.z, std::hypot(n.x, n.y))), .lon = longitude(n.x, n.y), .height_m = 0.0};
}

EcefDir Ellipsoid::surface_normal(const Ecef& on_surface) const {
  const glm::dvec3& p = on_surface.xyz_m;
  return EcefDir{glm::normalize(glm::dvec3(p.x, p.y, p.z / one_minus_e2()))};
}

std::optional<double> Ellipsoid::intersect_m(const Ecef& origin, const EcefDir& direction) const {
  const glm::dvec3 to_unit_sphere(1.0 / a_m_, 1.0 / a_m_, 1.0 / b_m());
  const RayQuadratic q = ray_quadratic(origin.xyz_m * to_unit_sphere, direction.xyz * to_unit_sphere);
  if (!std::isfinite(q.discriminant) || !std::isfinite(q.c)) return std::nullopt;

  if (q.c < 0.0) {  // inside there is always a crossing, so a discriminant below 0 is rounding
    const double root = std::sqrt(std::max(q.discriminant, 0.0));
    // The far root has two forms. Use the form that adds numbers of like sign; the other may be negative.
    return q.b >= 0.0 ? (q.b + root) / q.a : q.c / (q.b - root);
  }
  if (q.b < 0.0 || q.discriminant < 0.0) return std::nullopt;
  if (q.c == 0.0) return 0.0;
  return q.c / (q.b + std::sqrt(q.discriminant));  // (b - root) / a may be negative just over the surface
}

}  // namespace terrella
