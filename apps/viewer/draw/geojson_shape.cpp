#include "apps/viewer/draw/geojson_shape.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace terrella {
namespace {

constexpr double kPerDegree = 1e9;

// Adding 0 turns -0 into 0.
double rounded(double value) { return std::round(value * kPerDegree) / kPerDegree + 0.0; }

double twice_area(std::span<const GeoJsonPosition> ring) {
  double sum = 0.0;
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const auto& [x, y] = ring[k];
    const auto& [next_x, next_y] = ring[(k + 1) % ring.size()];
    sum += x * next_y - next_x * y;
  }
  return sum;
}

}  // namespace

double wrapped_lon_deg(double lon_deg) { return rounded(std::remainder(lon_deg, 360.0)); }

std::vector<GeoJsonPosition> line_positions(std::span<const Geodetic> places) {
  std::vector<GeoJsonPosition> positions;
  positions.reserve(places.size() + 1);
  double before_deg = places.empty() ? 0.0 : places[0].lon.deg();
  for (const Geodetic& place : places) {
    before_deg += std::remainder(place.lon.deg() - before_deg, 360.0);
    positions.push_back({rounded(before_deg), rounded(place.lat.deg())});
  }
  return positions;
}

std::vector<GeoJsonPosition> ring_positions(std::span<const Geodetic> places) {
  std::vector<GeoJsonPosition> ring = line_positions(places);
  if (ring.empty()) return ring;
  constexpr double kHalfTurn_deg = 180.0;
  if (std::abs(ring.back()[0] - ring.front()[0]) > kHalfTurn_deg) {
    for (GeoJsonPosition& position : ring) position[0] = wrapped_lon_deg(position[0]);
  } else if (twice_area(ring) < 0.0) {
    std::vector<Geodetic> turned(places.begin(), places.end());
    std::reverse(turned.begin() + 1, turned.end());
    ring = line_positions(turned);
  }
  ring.push_back(ring.front());
  return ring;
}

}  // namespace terrella
