#include "geo/great_circle.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "geo/ellipsoid.h"

namespace terrella {
namespace {

constexpr int kMostHalvings = 40;

glm::dvec3 direction(const MapPoint& p) {
  return Ellipsoid::normal(Angle::degrees(p.lat_deg), Angle::degrees(p.lon_deg)).xyz;
}

/// Returns the same place with a longitude within half a turn of `near_deg`.
MapPoint place_near(const glm::dvec3& n, double near_deg) {
  const double lon = Angle::radians(std::atan2(n.y, n.x)).deg();
  return {near_deg + std::remainder(lon - near_deg, 360.0),
          Angle::radians(std::atan2(n.z, std::hypot(n.x, n.y))).deg()};
}

/// Appends the points of the way from `a` to `b`, including `b` but not `a`.
void append_halves(const MapPoint& a, const MapPoint& b, int halvings, MapRing& ring) {
  const MapPoint flat{0.5 * (a.lon_deg + b.lon_deg), 0.5 * (a.lat_deg + b.lat_deg)};
  const glm::dvec3 middle = glm::normalize(direction(a) + direction(b));
  const double off_rad = glm::length(middle - direction(flat));
  if (halvings == kMostHalvings || off_rad <= Angle::degrees(kArcTolerance_deg).rad()) {
    ring.push_back(b);
    return;
  }
  const MapPoint on_arc = place_near(middle, flat.lon_deg);
  append_halves(a, on_arc, halvings + 1, ring);
  append_halves(on_arc, b, halvings + 1, ring);
}

bool is_pole(const MapPoint& p) { return std::abs(p.lat_deg) == 90.0; }

/// True if the edge from a position is a side of a box on a map that is 360° wide.
bool is_side_round(const std::vector<MapPoint>& ring, std::size_t i) {
  const std::size_t count = ring.size();
  const MapPoint &from = ring[i], &to = ring[(i + 1) % count];
  if (std::abs(to.lon_deg - from.lon_deg) != 360.0 || to.lat_deg != from.lat_deg) return false;
  return is_pole(from) ||
         (ring[(i + count - 1) % count].lon_deg == from.lon_deg && ring[(i + 2) % count].lon_deg == to.lon_deg);
}

/// True if a ring closes on the map, where sides of a box go once round the parallel.
bool closes_on_map(const std::vector<MapPoint>& ring) {
  double sum_deg = 0.0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const double turn_deg = ring[(i + 1) % ring.size()].lon_deg - ring[i].lon_deg;
    sum_deg += is_side_round(ring, i) ? turn_deg : std::remainder(turn_deg, 360.0);
  }
  return std::abs(sum_deg) < 180.0;
}

/// Appends the edge from the last point of the ring to a position, including that position.
Status append_edge(const MapPoint& given_from, const MapPoint& given_to, MapRing& ring) {
  const MapPoint from = ring.back();
  const double turn_deg = given_to.lon_deg - given_from.lon_deg;
  const double east_deg = std::remainder(turn_deg, 360.0);
  const MapPoint to{from.lon_deg + east_deg, given_to.lat_deg};
  if (is_pole(from) || is_pole(to) || east_deg == 0.0) {
    // A pole has every longitude: the edge is a meridian, and the rest of the edge stays at the pole.
    if (is_pole(from)) ring.push_back({to.lon_deg, from.lat_deg});
    if (is_pole(to) && !is_pole(from)) ring.push_back({from.lon_deg, to.lat_deg});
    ring.push_back(to);
    return Done{};
  }
  if (std::abs(east_deg) == 180.0) {
    const double sum_deg = from.lat_deg + to.lat_deg;
    if (sum_deg == 0.0) {
      return Error{
          fmt::format("from {},{} to {},{} there is no shorter way, they are antipodal; put a position between",
                      given_from.lon_deg, given_from.lat_deg, given_to.lon_deg, given_to.lat_deg)};
    }
    const double pole_deg = std::copysign(90.0, sum_deg);
    ring.insert(ring.end(), {{from.lon_deg, pole_deg}, {to.lon_deg, pole_deg}, to});
    return Done{};
  }
  append_halves(from, to, 0, ring);
  return Done{};
}

/// Returns twice the integral of sin(latitude) along a way round the planet; positive if the way is mostly in the
/// north.
double mean_side(const MapRing& ring) {
  double sum = 0.0;
  for (std::size_t i = 1; i < ring.size(); ++i) {
    const double sines =
        std::sin(Angle::degrees(ring[i].lat_deg).rad()) + std::sin(Angle::degrees(ring[i - 1].lat_deg).rad());
    sum += sines * (ring[i].lon_deg - ring[i - 1].lon_deg);
  }
  return ring.back().lon_deg > ring.front().lon_deg ? sum : -sum;
}

/// Cuts a ring with continuing longitudes, which lies within some turns round the planet, into parts within [-180,
/// 180]. Halves the turns again and again, so that each point is looked at few times.
void cut_into_turns(MapRing ring, int first, int last, std::vector<MapRing>& parts) {
  if (ring.size() < 2) return;
  if (first == last) {
    for (MapPoint& p : ring) p.lon_deg -= first * 360.0;
    return parts.push_back(std::move(ring));
  }
  const int middle = first + (last - first + 1) / 2;
  const double at_deg = middle * 360.0 - 180.0;
  cut_into_turns(clip_ring(ring, &MapPoint::lon_deg, at_deg, -1.0), first, middle - 1, parts);
  cut_into_turns(clip_ring(ring, &MapPoint::lon_deg, at_deg, 1.0), middle, last, parts);
}

std::vector<MapRing> cut_at_antimeridian(MapRing ring) {
  const auto [west, east] = std::ranges::minmax(ring, {}, &MapPoint::lon_deg);
  const int first = static_cast<int>(std::floor((west.lon_deg + 180.0) / 360.0));
  const int end = static_cast<int>(std::ceil((east.lon_deg + 180.0) / 360.0));
  std::vector<MapRing> parts;
  if (first < end) cut_into_turns(std::move(ring), first, end - 1, parts);
  return parts;
}

}  // namespace

Result<std::vector<MapRing>> rings_of(const std::vector<MapPoint>& positions) {
  MapRing ring{{std::remainder(positions.front().lon_deg, 360.0), positions.front().lat_deg}};
  const bool has_sides = closes_on_map(positions);
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const MapPoint& next = positions[(i + 1) % positions.size()];
    if (has_sides && is_side_round(positions, i)) {
      ring.push_back({ring.back().lon_deg + (next.lon_deg - positions[i].lon_deg), next.lat_deg});
      continue;
    }
    if (const Status edge = append_edge(positions[i], next, ring); !edge) return edge.error();
  }
  const double turns = std::round((ring.back().lon_deg - ring.front().lon_deg) / 360.0);
  if (std::abs(turns) > 1.0) return Error{"the ring goes round a pole more than once"};
  if (turns != 0.0) {
    const double pole_deg = std::copysign(90.0, mean_side(ring));
    ring.insert(ring.end(), {{ring.back().lon_deg, pole_deg}, {ring.front().lon_deg, pole_deg}});
  }
  return cut_at_antimeridian(std::move(ring));
}

double pieces_of(const std::vector<MapPoint>& positions) {
  // An arc of angle s deviates by up to s²/8 from its chord. Pieces have this length, or twice this length.
  const double piece_deg = Angle::radians(std::sqrt(8.0 * Angle::degrees(kArcTolerance_deg).rad())).deg();
  double turned_deg = 0.0;
  for (std::size_t i = 1; i < positions.size(); ++i) {
    const double east_deg = std::remainder(positions[i].lon_deg - positions[i - 1].lon_deg, 360.0);
    turned_deg += std::abs(east_deg) + std::abs(positions[i].lat_deg - positions[i - 1].lat_deg);
  }
  return double(positions.size()) + turned_deg / piece_deg;
}

}  // namespace terrella
