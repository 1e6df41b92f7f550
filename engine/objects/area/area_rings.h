#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "geo/map_plane.h"

// Rings of an area that is filled even-odd, in the plane of longitude and latitude. thread: any
namespace terrella {

using MapRings = std::vector<MapRing>;

[[nodiscard]] std::size_t points_of(const MapRings& rings);
[[nodiscard]] MapRing ring_of(const MapRect& rect);
/// Clips each ring (clip_ring()) at a meridian or parallel into parts with smaller and with larger coordinates. Points
/// that cancel each other are left out.
[[nodiscard]] std::pair<MapRings, MapRings> divided(MapRings rings, double MapPoint::*axis, double at_deg);
/// Removes rings that only follow the rectangle's border. `full` is inverted if together they cover the rectangle.
[[nodiscard]] MapRings without_whole_turns(MapRings rings, const MapRect& rect, bool& full);
/// Removes pairs of equal rings, which cancel each other. Also rings of one place. Costs n log n.
[[nodiscard]] MapRings without_pairs(MapRings rings);

}  // namespace terrella
