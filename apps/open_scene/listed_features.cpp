#include "apps/open_scene/listed_features.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <utility>

#include "geo/ellipsoid.h"

namespace terrella {
namespace {

/// A part of a feature, and what decides between parts.
struct Part {
  ListedFeature feature;
  int rank = 0;  ///< lower ones win
  double size_deg = 0.0;
};

glm::dvec3 direction(const Geodetic& place) { return Ellipsoid::normal(place.lat, place.lon).xyz; }

double angle_between(const Geodetic& a, const Geodetic& b) {
  return std::acos(std::clamp(glm::dot(direction(a), direction(b)), -1.0, 1.0));
}

/// The place after a share of the way, [0, 1], along the great circle.
Geodetic place_between(const Geodetic& a, const Geodetic& b, double share) {
  const double angle = angle_between(a, b), sine = std::sin(angle);
  if (sine < 1e-9) return a;
  const glm::dvec3 at =
      (std::sin((1.0 - share) * angle) * direction(a) + std::sin(share * angle) * direction(b)) / sine;
  Geodetic place = Ellipsoid::lat_lon({at});
  place.height_m = (1.0 - share) * a.height_m + share * b.height_m;
  return place;
}

double length(const std::vector<Geodetic>& places) {
  double whole = 0.0;
  for (std::size_t k = 1; k < places.size(); ++k) whole += angle_between(places[k - 1], places[k]);
  return whole;
}

Geodetic middle_of(const std::vector<Geodetic>& places) {
  double left = 0.5 * length(places);
  for (std::size_t k = 1; k < places.size(); ++k) {
    const double step = angle_between(places[k - 1], places[k]);
    if (step > 0.0 && left <= step) return place_between(places[k - 1], places[k], left / step);
    left -= step;
  }
  return places.front();
}

/// Longitude of a place, not more than 180° from that of another one.
double near_deg(const Geodetic& place, double lon_deg) {
  return lon_deg + std::remainder(place.lon.deg() - lon_deg, 360.0);
}

/// Longitudes where the edges of an area cross a parallel, ascending.
std::vector<double> crossings(const std::vector<std::vector<Geodetic>>& rings, double lat_deg) {
  std::vector<double> found;
  for (const std::vector<Geodetic>& ring : rings) {
    if (ring.empty()) continue;
    double lon_deg = near_deg(ring.back(), rings.front().front().lon.deg());
    for (std::size_t k = 0; k < ring.size(); ++k) {
      const Geodetic& before = ring[k == 0 ? ring.size() - 1 : k - 1];
      const double from_deg = std::exchange(lon_deg, near_deg(ring[k], lon_deg));
      const double low_deg = before.lat.deg(), high_deg = ring[k].lat.deg();
      if ((low_deg > lat_deg) == (high_deg > lat_deg)) continue;
      found.push_back(from_deg + (lon_deg - from_deg) * (lat_deg - low_deg) / (high_deg - low_deg));
    }
  }
  std::ranges::sort(found);
  return found;
}

double lowest_deg(const std::vector<Geodetic>& ring) {
  return std::ranges::min_element(ring, {}, [](const Geodetic& place) { return place.lat.deg(); })->lat.deg();
}

double highest_deg(const std::vector<Geodetic>& ring) {
  return std::ranges::max_element(ring, {}, [](const Geodetic& place) { return place.lat.deg(); })->lat.deg();
}

// An area without a middle, such as one around a pole, has its first place.
Geodetic inside(const std::vector<std::vector<Geodetic>>& rings) {
  const std::vector<Geodetic>& outer = rings.front();
  const double lat_deg = 0.5 * (lowest_deg(outer) + highest_deg(outer));
  const std::vector<double> edges = crossings(rings, lat_deg);
  std::optional<std::pair<double, double>> widest;
  for (std::size_t k = 1; k < edges.size(); k += 2) {
    if (!widest || edges[k] - edges[k - 1] > widest->second - widest->first) widest = {edges[k - 1], edges[k]};
  }
  if (!widest || edges.size() % 2 == 1) return outer.front();
  double height_m = 0.0;
  for (const Geodetic& place : outer) height_m += place.height_m / static_cast<double>(outer.size());
  const double lon_deg = std::remainder(0.5 * (widest->first + widest->second), 360.0);
  return {.lat = Angle::degrees(lat_deg), .lon = Angle::degrees(lon_deg), .height_m = height_m};
}

template <class Object>
void take_placed(const std::vector<Object>& objects, ObjectKind kind, int rank, std::vector<Part>& parts) {
  for (const Object& object : objects) parts.push_back({{object.of, kind, object.place, object.heights}, rank, 0.0});
}

void take_lines(const ObjectScene& scene, std::vector<Part>& parts) {
  for (const LineObject& line : scene.lines) {
    if (line.places.empty()) continue;
    parts.push_back({{line.of, ObjectKind::line, middle_of(line.places), line.heights},
                     2,
                     Angle::radians(length(line.places)).deg()});
  }
}

void take_areas(const ObjectScene& scene, std::vector<Part>& parts) {
  for (const PolygonObject& area : scene.polygons) {
    if (area.rings.empty() || area.rings.front().empty()) continue;
    parts.push_back({{area.of, ObjectKind::polygon, inside(area.rings), area.heights},
                     3,
                     highest_deg(area.rings.front()) - lowest_deg(area.rings.front())});
  }
}

}  // namespace

std::vector<ListedFeature> listed_features(const ObjectScene& scene) {
  std::vector<Part> parts;
  take_placed(scene.points, ObjectKind::point, 0, parts);
  take_placed(scene.meshes, ObjectKind::mesh, 1, parts);
  take_lines(scene, parts);
  take_areas(scene, parts);
  take_placed(scene.labels, ObjectKind::label, 4, parts);
  std::erase_if(parts, [](const Part& part) { return part.feature.of.id == ObjectId::none; });
  std::ranges::stable_sort(parts, [](const Part& a, const Part& b) {
    if (a.feature.of.id != b.feature.of.id) return a.feature.of.id < b.feature.of.id;
    return a.rank != b.rank ? a.rank < b.rank : a.size_deg > b.size_deg;
  });
  std::vector<ListedFeature> features;
  features.reserve(parts.size());
  for (Part& part : parts) {
    if (features.empty() || features.back().of.id != part.feature.of.id) features.push_back(std::move(part.feature));
  }
  return features;
}

}  // namespace terrella
