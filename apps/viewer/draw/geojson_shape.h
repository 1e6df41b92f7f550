#pragma once

#include <array>
#include <span>
#include <vector>

#include "geo/coordinates.h"

// thread: any, for all of this header
namespace terrella {

/// Longitude and latitude in degrees, of at most 9 decimals (0.1 mm on Earth).
using GeoJsonPosition = std::array<double, 2>;

/// The positions of a line. Each longitude is within 180° of the one before, so a way across ±180° has longitudes
/// beyond ±180°.
[[nodiscard]] std::vector<GeoJsonPosition> line_positions(std::span<const Geodetic> places);

/// The positions of an area's outer ring, against the clock as RFC 7946 asks. The last position repeats the first,
/// which is the first place. A ring round a pole does not close beyond ±180°; its longitudes are in [-180, 180].
[[nodiscard]] std::vector<GeoJsonPosition> ring_positions(std::span<const Geodetic> places);

/// A longitude in [-180, 180] for one beyond.
[[nodiscard]] double wrapped_lon_deg(double lon_deg);

}  // namespace terrella
