#include "objects/area/area_rings.h"

#include <algorithm>
#include <cmath>
#include <compare>

namespace terrella {
namespace {

double area(const MapRing& ring) {
  double twice = 0.0;
  const MapPoint& o = ring.front();
  for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
    const MapPoint &a = ring[i], &b = ring[i + 1];
    twice += (a.lon_deg - o.lon_deg) * (b.lat_deg - o.lat_deg) - (b.lon_deg - o.lon_deg) * (a.lat_deg - o.lat_deg);
  }
  return 0.5 * twice;
}

bool is_on_border(const MapRing& ring, const MapRect& rect) {
  return std::ranges::all_of(ring, [&rect](const MapPoint& p) {
    return p.lon_deg == rect.west_deg || p.lon_deg == rect.east_deg || p.lat_deg == rect.south_deg ||
           p.lat_deg == rect.north_deg;
  });
}

std::partial_ordering order(const MapPoint& a, const MapPoint& b) {
  const auto by_lon = a.lon_deg <=> b.lon_deg;
  return by_lon != 0 ? by_lon : a.lat_deg <=> b.lat_deg;
}
bool is_before(const MapPoint& a, const MapPoint& b) { return order(a, b) < 0; }
bool is_same(const MapPoint& a, const MapPoint& b) { return order(a, b) == 0; }

/// True if the last 8 edges go round a loop of 4 points twice, as a ring does that a clip wound round a rectangle.
bool ends_in_two_loops(const MapRing& ring) {
  constexpr std::size_t kLoop = 4;
  const std::size_t n = ring.size();
  if (n <= 2 * kLoop) return false;
  for (std::size_t k = n - kLoop; k < n; ++k) {
    if (!is_same(ring[k], ring[k - kLoop])) return false;
  }
  return is_same(ring[n - 1], ring[n - 1 - 2 * kLoop]);
}

/// Removes points that repeat, edges that lead there and back, and loops that are run through twice: all of them cancel
/// under even-odd filling. A clip makes many of them out of edges that pass beside a rectangle.
void shorten(MapRing& ring) {
  MapRing left;
  for (const MapPoint& p : ring) {
    if (!left.empty() && is_same(left.back(), p)) continue;
    if (left.size() >= 2 && is_same(left[left.size() - 2], p)) {
      left.pop_back();
      continue;
    }
    left.push_back(p);
    if (ends_in_two_loops(left)) left.resize(left.size() - 8);
  }
  while (left.size() > 1 && is_same(left.front(), left.back())) left.pop_back();
  ring = std::move(left);
}

void add_clipped(MapRings& parts, const MapRing& ring, double MapPoint::*axis, double at_deg, double side) {
  MapRing part = clip_ring(ring, axis, at_deg, side);
  shorten(part);
  if (part.size() >= 3) parts.push_back(std::move(part));
}

/// Gives equal rings the same first point and the same direction.
void normalize(MapRing& ring) {
  shorten(ring);
  std::rotate(ring.begin(), std::ranges::min_element(ring, is_before), ring.end());
  if (ring.size() > 2 && is_before(ring.back(), ring[1])) std::reverse(ring.begin() + 1, ring.end());
}

}  // namespace

std::size_t points_of(const MapRings& rings) {
  std::size_t points = 0;
  for (const MapRing& ring : rings) points += ring.size();
  return points;
}

MapRing ring_of(const MapRect& r) {
  return {{r.west_deg, r.south_deg}, {r.east_deg, r.south_deg}, {r.east_deg, r.north_deg}, {r.west_deg, r.north_deg}};
}

std::pair<MapRings, MapRings> divided(MapRings rings, double MapPoint::*axis, double at_deg) {
  std::pair<MapRings, MapRings> parts;
  for (MapRing& ring : rings) {
    const auto [low, high] = std::ranges::minmax(ring, {}, axis);
    if (high.*axis <= at_deg) {
      parts.first.push_back(std::move(ring));
    } else if (low.*axis >= at_deg) {
      parts.second.push_back(std::move(ring));
    } else {
      add_clipped(parts.first, ring, axis, at_deg, -1.0);
      add_clipped(parts.second, ring, axis, at_deg, 1.0);
    }
  }
  return parts;
}

MapRings without_whole_turns(MapRings rings, const MapRect& rect, bool& full) {
  const double whole = (rect.east_deg - rect.west_deg) * (rect.north_deg - rect.south_deg);
  std::erase_if(rings, [&](const MapRing& ring) {
    constexpr double kRounding = 1e-9;
    if (!is_on_border(ring, rect)) return false;
    const double turns = area(ring) / whole;
    if (std::abs(turns - std::round(turns)) > kRounding) return false;
    if (std::fmod(std::round(std::abs(turns)), 2.0) == 1.0) full = !full;
    return true;
  });
  return rings;
}

MapRings without_pairs(MapRings rings) {
  for (MapRing& ring : rings) normalize(ring);
  std::erase_if(rings, [](const MapRing& ring) { return ring.size() < 3; });
  const auto before = [](const MapRing& a, const MapRing& b) {
    return std::ranges::lexicographical_compare(a, b, is_before);
  };
  std::ranges::sort(rings, before);
  MapRings left;
  for (MapRing& ring : rings) {
    if (!left.empty() && std::ranges::equal(left.back(), ring, is_same)) {
      left.pop_back();
    } else {
      left.push_back(std::move(ring));
    }
  }
  return left;
}

}  // namespace terrella
