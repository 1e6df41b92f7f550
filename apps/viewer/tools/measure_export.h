#pragma once

#include <span>
#include <string>

#include "geo/coordinates.h"
#include "geo/ellipsoid.h"

// thread: any, for all of this header
namespace terrella {

/// A measurement as lines of text for the clipboard: each place with the length of the way to it in metres, then the
/// total and, from three places on, the area in square metres. Columns are separated by tabs.
[[nodiscard]] std::string measurement_text(const Ellipsoid& ellipsoid, std::span<const Geodetic> places);

/// A measurement as GeoJSON (RFC 7946): a Point, or a LineString with its lengths in metres and, from three places on,
/// a Polygon with its area in square metres. Positions: draw/geojson_shape.h.
[[nodiscard]] std::string measurement_geojson(const Ellipsoid& ellipsoid, std::span<const Geodetic> places);

}  // namespace terrella
