#pragma once

#include <span>
#include <vector>

#include "geo/coordinates.h"
#include "geo/ellipsoid.h"

// thread: any, for all of this header
namespace terrella {

// Distances and areas on the ellipsoid, by GeographicLib's exact geodesics (C. F. F. Karney, J. Geodesy 87 (2013), and
// GeodesicExact for any flattening). Error: nanometres on Earth. Heights are ignored. A latitude that rounding put
// beyond a pole counts as the pole. thread: any

/// Length of the shortest way between two places, metres.
[[nodiscard]] double geodesic_m(const Ellipsoid& ellipsoid, const Geodetic& from, const Geodetic& to);

/// Length of the way from the first place through all others to the last, metres; 0 for fewer than two places.
[[nodiscard]] double path_m(const Ellipsoid& ellipsoid, std::span<const Geodetic> places);

/// Returns places at equal distances on the shortest way between two places, `count` with both ends, at least 2. The
/// height changes evenly.
[[nodiscard]] std::vector<Geodetic> geodesic_places(const Ellipsoid& ellipsoid, const Geodetic& from,
                                                    const Geodetic& to, int count);

/// Returns a ring round all places within `radius_m` of the shortest way between two places, in order; a circle if the
/// places are one. The ring and the edges between its places lie at radius_m to 1.003 · radius_m from the way. Way and
/// radius are at most a quarter of the equatorial radius.
[[nodiscard]] std::vector<Geodetic> ring_around_way(const Ellipsoid& ellipsoid, const Geodetic& from,
                                                    const Geodetic& to, double radius_m);

struct PolygonMeasure {
  /// Area of the smaller side, never negative; for a ring that crosses itself, the difference of its two sides.
  double area_m2 = 0.0;
  double perimeter_m = 0.0;  ///< includes the way from the last place to the first
};

/// Measures a ring of geodesics, which may cross ±180° or go round a pole. The area is 0 for fewer than three places.
[[nodiscard]] PolygonMeasure polygon_measure(const Ellipsoid& ellipsoid, std::span<const Geodetic> ring);

}  // namespace terrella
