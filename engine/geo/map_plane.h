#pragma once

#include <vector>

// thread: any, for all of this header
namespace terrella {

/// A place in the plane of longitude and geodetic latitude, degrees. In this plane every tile is a rectangle.
/// Longitudes of a ring under construction continue past ±180°. Longitudes of a finished region lie in [-180, 180].
struct MapPoint {
  double lon_deg = 0.0;
  double lat_deg = 0.0;
};

/// A rectangle of the map plane; west < east, south < north.
struct MapRect {
  double west_deg = -180.0;
  double south_deg = -90.0;
  double east_deg = 180.0;
  double north_deg = 90.0;
};

/// A closed ring. An edge joins the last point to the first.
using MapRing = std::vector<MapPoint>;

/// Returns the smallest rectangle around rings. Without a point west is 180° and east -180°, south 90° and north -90°.
/// thread: any
[[nodiscard]] MapRect bounds_of(const std::vector<MapRing>& rings);

/// Clips a ring at a meridian or parallel, `axis` = `at_deg`. `side` 1 keeps the part with larger coordinates, -1 the
/// part with smaller ones (Sutherland and Hodgman 1974, doi:10.1145/360767.360802). Edges added along the cut cancel
/// under even-odd filling. Points on the cut have exactly its coordinate. thread: any
[[nodiscard]] MapRing clip_ring(const MapRing& ring, double MapPoint::*axis, double at_deg, double side);

}  // namespace terrella
