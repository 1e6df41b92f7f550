#pragma once

#include <span>

#include "geo/coordinates.h"
#include "geo/ellipsoid.h"

// thread: any, for all of this header
namespace terrella {

// Distances and areas on the ellipsoid itself, by GeographicLib's exact geodesics (C. F. F. Karney, J. Geodesy 87
// (2013), and GeodesicExact for any flattening): nanometres on Earth. Heights do not count. Latitudes beyond a pole by
// rounding are taken at the pole. thread: any

/// Metres of the shortest way.
[[nodiscard]] double geodesic_m(const Ellipsoid& ellipsoid, const Geodetic& from, const Geodetic& to);

/// Metres from the first place over all others to the last; 0 of fewer than two.
[[nodiscard]] double path_m(const Ellipsoid& ellipsoid, std::span<const Geodetic> places);

struct PolygonMeasure {
  double area_m2 = 0.0;  ///< of the smaller side, never negative; of a ring that crosses itself what remains of both
  double perimeter_m = 0.0;  ///< with the way from the last place to the first
};

/// A ring of geodesics, over ±180° and around a pole too; nothing encloses an area of fewer than three places.
[[nodiscard]] PolygonMeasure polygon_measure(const Ellipsoid& ellipsoid, std::span<const Geodetic> ring);

}  // namespace terrella
