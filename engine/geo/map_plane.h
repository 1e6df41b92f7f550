#pragma once

#include <vector>

// thread: any, for all of this header
namespace terrella {

/// A place in the plane of longitude and geodetic latitude, degrees: there every tile is a rectangle. Longitudes of a
/// ring that is being built run on over ±180°; those of a region lie in [-180, 180].
struct MapPoint {
  double lon_deg = 0.0;
  double lat_deg = 0.0;
};

/// A rectangle of that plane; west < east, south < north.
struct MapRect {
  double west_deg = -180.0;
  double south_deg = -90.0;
  double east_deg = 180.0;
  double north_deg = 90.0;
};

/// A closed ring; the last point is joined to the first.
using MapRing = std::vector<MapPoint>;

/// The part of a ring on one side of a meridian or parallel, `axis` = `at_deg`: `side` 1 keeps the larger, -1 the
/// smaller (Sutherland and Hodgman 1974, doi:10.1145/360767.360802). What is joined along the cut cancels out under
/// even-odd filling; points on the cut have exactly its coordinate.
[[nodiscard]] MapRing clip_ring(const MapRing& ring, double MapPoint::*axis, double at_deg, double side);

}  // namespace terrella
