#include "objects/object_shapes.h"

#include <GeographicLib/GeodesicExact.hpp>
#include <GeographicLib/GeodesicLineExact.hpp>
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>

namespace terrella {
namespace {

using glm::dvec3;

/// Geodesics on one ellipsoid. Uses the exact form, because the series loses digits on flat bodies such as Saturn.
class GeodesicWays {
 public:
  explicit GeodesicWays(const Ellipsoid& ellipsoid) : ellipsoid_(ellipsoid) {}

  /// Calls use(place) for the places at 1/n, 2/n … of the way, without the last.
  template <class Use>
  void between(const Geodetic& a, const Geodetic& b, int n, Use use) {
    if (!geodesics_) geodesics_.emplace(ellipsoid_.a_m(), ellipsoid_.f());
    const auto way = geodesics_->InverseLine(latitude_deg(a), a.lon.deg(), latitude_deg(b), b.lon.deg());
    for (int k = 1; k < n; ++k) {
      const double part = double(k) / n;
      double lat = 0.0, lon = 0.0;
      way.Position(part * way.Distance(), lat, lon);
      use(Geodetic{.lat = Angle::degrees(lat),
                   .lon = Angle::degrees(lon),
                   .height_m = a.height_m + part * (b.height_m - a.height_m)});
    }
  }

 private:
  // Rounding to radians and back may put a latitude beyond the pole.
  static double latitude_deg(const Geodetic& p) { return std::clamp(p.lat.deg(), -90.0, 90.0); }

  Ellipsoid ellipsoid_;
  std::optional<GeographicLib::GeodesicExact> geodesics_;  ///< takes long to make, and short lines need none
};

Angle between(const Geodetic& a, const Geodetic& b) {
  const dvec3 p = Ellipsoid::normal(a.lat, a.lon).xyz, q = Ellipsoid::normal(b.lat, b.lon).xyz;
  return Angle::radians(std::atan2(glm::length(glm::cross(p, q)), glm::dot(p, q)));
}

/// Number of pieces; 1 if the way is not finite.
int pieces(Angle way, Angle step) {
  constexpr double kMost = 1.0e6;
  const double pieces = std::ceil(way / step);
  return pieces > 1.0 ? static_cast<int>(std::min(pieces, kMost)) : 1;
}

dvec3 lifted(const Geodetic& place, const Ellipsoid& ellipsoid, double lift_m) {
  Geodetic higher = place;
  higher.height_m += lift_m;
  return ellipsoid.to_ecef(higher).xyz_m;
}

/// Appends the places at 1/n, 2/n … of the great circle of normals, without the last. None for antipodes.
void along_great_circle(const Geodetic& a, const Geodetic& b, int n, const Ellipsoid& ellipsoid, double lift_m,
                        std::vector<dvec3>& out) {
  const dvec3 p = Ellipsoid::normal(a.lat, a.lon).xyz, q = Ellipsoid::normal(b.lat, b.lon).xyz;
  const double angle = between(a, b).rad();
  const double sine = std::sin(angle);
  if (sine < 1e-12) return;
  for (int k = 1; k < n; ++k) {
    const double part = double(k) / n;
    const dvec3 normal = (std::sin((1.0 - part) * angle) * p + std::sin(part * angle) * q) / sine;
    const double height_m = a.height_m + part * (b.height_m - a.height_m) + lift_m;
    out.push_back(ellipsoid.position(EcefDir{glm::normalize(normal)}, height_m).xyz_m);
  }
}

}  // namespace

glm::dvec3 level_direction(const Geodetic& place, Angle heading) {
  const double sin_lat = std::sin(place.lat.rad()), cos_lat = std::cos(place.lat.rad());
  const double sin_lon = std::sin(place.lon.rad()), cos_lon = std::cos(place.lon.rad());
  const glm::dvec3 east(-sin_lon, cos_lon, 0.0), north(-sin_lat * cos_lon, -sin_lat * sin_lon, cos_lat);
  return std::sin(heading.rad()) * east + std::cos(heading.rad()) * north;
}

double sag_m(const Ellipsoid& ellipsoid, Angle step) {
  const double radius_m = ellipsoid.a_m() / (1.0 - ellipsoid.f());  // largest radius of curvature, at a pole
  return radius_m * (1.0 - std::cos(0.5 * step.rad()));
}

Angle length_of(const std::vector<Geodetic>& places) {
  Angle length{};
  for (std::size_t k = 1; k < places.size(); ++k) length = length + between(places[k - 1], places[k]);
  return length;
}

std::vector<dvec3> line_along_geodesics(const std::vector<Geodetic>& places, const Ellipsoid& ellipsoid, Angle step) {
  if (places.empty()) return {};
  GeodesicWays ways(ellipsoid);
  const double lift_m = is_underground(places) ? 0.0 : sag_m(ellipsoid, step);
  std::vector<dvec3> line{lifted(places.front(), ellipsoid, lift_m)};
  for (std::size_t k = 1; k < places.size(); ++k) {
    const int n = pieces(between(places[k - 1], places[k]), step);
    const auto add = [&](const Geodetic& place) { line.push_back(lifted(place, ellipsoid, lift_m)); };
    if (n > 1) ways.between(places[k - 1], places[k], n, add);
    line.push_back(lifted(places[k], ellipsoid, lift_m));
  }
  return line;
}

std::vector<EcefDir> normals_along_geodesics(const std::vector<Geodetic>& places, const Ellipsoid& ellipsoid,
                                             Angle step) {
  if (places.empty()) return {};
  GeodesicWays ways(ellipsoid);
  std::vector<EcefDir> line{Ellipsoid::normal(places.front().lat, places.front().lon)};
  const auto add = [&](const Geodetic& place) { line.push_back(Ellipsoid::normal(place.lat, place.lon)); };
  for (std::size_t k = 1; k < places.size(); ++k) {
    const int n = pieces(between(places[k - 1], places[k]), step);
    if (n > 1) ways.between(places[k - 1], places[k], n, add);
    add(places[k]);
  }
  return line;
}

std::vector<dvec3> outline(const std::vector<Geodetic>& ring, const Ellipsoid& ellipsoid, Angle step, double lift_m) {
  if (ring.empty()) return {};
  std::vector<dvec3> line{lifted(ring.front(), ellipsoid, lift_m)};
  for (std::size_t k = 1; k <= ring.size(); ++k) {
    const Geodetic& a = ring[k - 1];
    const Geodetic& b = ring[k % ring.size()];
    const int n = pieces(between(a, b), step);
    if (n > 1) along_great_circle(a, b, n, ellipsoid, lift_m, line);
    const dvec3 end = lifted(b, ellipsoid, lift_m);
    if (end != line.back()) line.push_back(end);
  }
  return line;
}

}  // namespace terrella
