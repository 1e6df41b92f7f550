#pragma once

#include <algorithm>
#include <utility>

#include "geo/objects.h"
#include "objects/solid/solid_area.h"
#include "view/ground.h"

// Heights of objects over the drawn ground. thread: as Ground's
namespace terrella {

/// Returns a place of an object with its height over the ellipsoid.
[[nodiscard]] inline Geodetic over_ground(Geodetic place, HeightMode mode, const Ground& ground) {
  if (mode == HeightMode::absolute) return place;
  const double over_m = mode == HeightMode::relative_to_ground ? place.height_m : 0.0;
  place.height_m = ground.height_m(place.lat, place.lon) + over_m;
  return place;
}

/// True if a line or an area lies on the ground: draped, or at the height of ground without heights.
[[nodiscard]] inline bool lies_on_ground(const LineObject& line, const Ground& ground) {
  if (is_draped(line)) return true;
  return line.heights == HeightMode::absolute && !line.through_surface && !ground.has_relief() &&
         std::ranges::all_of(line.places, [](const Geodetic& place) { return place.height_m == 0.0; });
}
[[nodiscard]] inline bool lies_on_ground(const PolygonObject& area, const Ground& ground) {
  if (is_draped(area)) return true;
  return area.heights == HeightMode::absolute && !area.through_surface && !is_extruded(area) && !ground.has_relief() &&
         std::ranges::all_of(area.rings, [](const auto& ring) {
           return std::ranges::all_of(ring, [](const Geodetic& place) { return place.height_m == 0.0; });
         });
}

/// Returns a place of a line or an area as it is cut. If they lie on the ground, they are cut on the ellipsoid: the
/// ground gives them heights when they are drawn or picked.
[[nodiscard]] inline Geodetic cut_place(Geodetic place, HeightMode mode, const Ground& ground) {
  if (mode != HeightMode::clamp_to_ground) return over_ground(place, mode, ground);
  place.height_m = 0.0;
  return place;
}

/// Returns a line or an area with the places of cut_place().
[[nodiscard]] inline LineObject cut_shape(LineObject line, const Ground& ground) {
  for (Geodetic& place : line.places) place = cut_place(place, line.heights, ground);
  return line;
}
[[nodiscard]] inline PolygonObject cut_shape(PolygonObject area, const Ground& ground) {
  if (is_extruded(area)) return standing_shape(std::move(area), ground);
  for (auto& ring : area.rings) {
    for (Geodetic& place : ring) place = cut_place(place, area.heights, ground);
  }
  return area;
}

}  // namespace terrella
