#include "geo/map_plane.h"

namespace terrella {

MapRing clip_ring(const MapRing& ring, double MapPoint::*axis, double at_deg, double side) {
  MapRing kept;
  kept.reserve(ring.size() + 2);
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const MapPoint& a = ring[i];
    const MapPoint& b = ring[(i + 1) % ring.size()];
    const bool a_in = side * (a.*axis - at_deg) >= 0.0;
    const bool b_in = side * (b.*axis - at_deg) >= 0.0;
    if (a_in) kept.push_back(a);
    if (a_in == b_in || a.*axis == at_deg || b.*axis == at_deg) continue;
    const double part = (at_deg - a.*axis) / (b.*axis - a.*axis);
    MapPoint crossing{a.lon_deg + part * (b.lon_deg - a.lon_deg), a.lat_deg + part * (b.lat_deg - a.lat_deg)};
    crossing.*axis = at_deg;
    kept.push_back(crossing);
  }
  return kept;
}

MapRect bounds_of(const std::vector<MapRing>& rings) {
  MapRect box{180.0, 90.0, -180.0, -90.0};
  for (const MapRing& ring : rings) {
    for (const MapPoint& p : ring) {
      box.west_deg = std::min(box.west_deg, p.lon_deg);
      box.east_deg = std::max(box.east_deg, p.lon_deg);
      box.south_deg = std::min(box.south_deg, p.lat_deg);
      box.north_deg = std::max(box.north_deg, p.lat_deg);
    }
  }
  return box;
}

}  // namespace terrella
