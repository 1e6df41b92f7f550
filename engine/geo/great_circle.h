#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "geo/map_plane.h"

// thread: any, for all of this header
namespace terrella {

/// Largest distance between an arc and the straight pieces that replace it, degrees on the sphere; 1.1 m on Earth.
inline constexpr double kArcTolerance_deg = 1.0e-5;

/// Converts a ring of positions on the sphere to rings of the map plane within [-180, 180]. They enclose the same area,
/// cut at ±180° if the ring crosses it.
///
/// Edges are the shorter great circles of the sphere of geodetic latitude and longitude, in straight pieces. An edge
/// between two places of one meridian follows the meridian. An edge between one place and the same place written 360°
/// further has no length, unless it is a side of a box that closes on the map: both neighbours of the edge lie on its
/// meridians, or it lies at a pole. A side runs once round the parallel, so that a box of the whole planet keeps its
/// meaning. A ring that goes round a pole encloses the cap of the smaller area. Any other ring encloses the area
/// between its longitudes.
///
/// Fails if neighbours are antipodal (no shorter way), and if a ring goes round a pole more than once. Latitudes must
/// be in [-90, 90], longitudes finite. The last position may repeat the first. thread: any
[[nodiscard]] Result<std::vector<MapRing>> rings_of(const std::vector<MapPoint>& positions);

/// Estimates the number of pieces that rings_of() makes of a ring, on the high side. The memory that rings_of() needs
/// follows from this number. thread: any
[[nodiscard]] double pieces_of(const std::vector<MapPoint>& positions);

}  // namespace terrella
