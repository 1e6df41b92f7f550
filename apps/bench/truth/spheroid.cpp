#include "apps/bench/truth/spheroid.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace terrella::truth {

namespace {
constexpr double kDegree = std::numbers::pi / 180.0;
}

LocalFrame local_frame(double lat_deg, double lon_deg) {
  const double sin_lat = std::sin(lat_deg * kDegree);
  const double cos_lat = std::cos(lat_deg * kDegree);
  const double sin_lon = std::sin(lon_deg * kDegree);
  const double cos_lon = std::cos(lon_deg * kDegree);
  return {.east = {-sin_lon, cos_lon, 0.0},
          .north = {-sin_lat * cos_lon, -sin_lat * sin_lon, cos_lat},
          .up = {cos_lat * cos_lon, cos_lat * sin_lon, sin_lat}};
}

glm::dvec3 position_m(const Spheroid& body, const Place& place) {
  const glm::dvec3 up = local_frame(place.lat_deg, place.lon_deg).up;
  const double b_over_a_squared = (1.0 - body.f) * (1.0 - body.f);
  // Radius of curvature in the prime vertical: a² / sqrt(a² cos² + b² sin²).
  const double n = body.a_m / std::sqrt(up.x * up.x + up.y * up.y + b_over_a_squared * up.z * up.z);
  return glm::dvec3(n * up.x, n * up.y, n * b_over_a_squared * up.z) + place.height_m * up;
}

std::optional<Hit> first_hit(const Spheroid& body, const glm::dvec3& eye_m, const glm::dvec3& direction) {
  const double a = body.a_m;
  const double b = body.b_m();
  const glm::dvec3 o(eye_m.x / a, eye_m.y / a, eye_m.z / b);
  const glm::dvec3 d(direction.x / a, direction.y / a, direction.z / b);
  const double dd = glm::dot(d, d);
  const double t_closest = -glm::dot(o, d) / dd;
  const glm::dvec3 closest = o + t_closest * d;
  const double gap = 1.0 - glm::dot(closest, closest);
  if (!(gap >= 0.0)) return std::nullopt;
  const double half_chord = std::sqrt(gap / dd);
  double t = t_closest - half_chord;
  if (t <= 0.0) t = t_closest + half_chord;
  if (!(t > 0.0)) return std::nullopt;
  const glm::dvec3 unit = o + t * d;  // on the unit sphere
  const glm::dvec3 gradient(unit.x / a, unit.y / a, unit.z / b);
  return Hit{{a * unit.x, a * unit.y, b * unit.z}, gradient / std::sqrt(glm::dot(gradient, gradient)), t};
}

double latitude_rad(const glm::dvec3& normal) {
  return std::atan2(normal.z, std::sqrt(normal.x * normal.x + normal.y * normal.y));
}

double longitude_rad(const glm::dvec3& normal) { return std::atan2(normal.y, normal.x); }

}  // namespace terrella::truth
