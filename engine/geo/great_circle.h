#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "geo/map_plane.h"

// thread: any, for all of this header
namespace terrella {

/// How far the straight pieces that stand for an arc may be from it, degrees on the sphere; 1.1 m on Earth.
inline constexpr double kArcTolerance_deg = 1.0e-5;

/// A ring of positions on the sphere as rings of the map plane within [-180, 180]: the area that it encloses, cut at
/// ±180° where it crosses it.
///
/// Edges are great circles of the sphere of geodetic latitude and longitude, the shorter way, in pieces. Two ends on
/// one meridian run along it; two ends that are the same place written 360° apart run once round their parallel (so
/// that a box of the whole planet is what it looks like). A ring that goes round a pole encloses the cap of the smaller
/// area; one that does not encloses what lies between its longitudes.
///
/// Fails for antipodal neighbours (no shorter way), and for a ring that goes round a pole more than once. The
/// positions' latitudes must be in [-90, 90], their longitudes finite. The last position may repeat the first. thread:
/// any
[[nodiscard]] Result<std::vector<MapRing>> rings_of(const std::vector<MapPoint>& positions);

/// About how many pieces rings_of() makes of a ring, rather too many: what the memory it takes follows from.
[[nodiscard]] double pieces_of(const std::vector<MapPoint>& positions);

}  // namespace terrella
