#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "base/result.h"
#include "geo/ellipsoid.h"
#include "streaming/preload/region.h"

namespace terrella {

/// Reads the lines of GeoJSON text (RFC 7946) as the region of all places within `radius_m` of them: LineString,
/// MultiLineString, and Feature, FeatureCollection and GeometryCollection of lines. Legs are geodesics of the
/// ellipsoid, the shorter way. The region may reach beyond the radius by 1/100 of it and 2 m, and leaves out nothing.
/// Ignores third coordinates. The error begins with `where` (a path) and names the feature, counted from 1. thread: any
[[nodiscard]] Result<Region> parse_geojson_route(std::string_view text, const std::string& where, double radius_m,
                                                 const Ellipsoid& ellipsoid);
/// Reads a route from a file.
[[nodiscard]] Result<Region> read_geojson_route(const std::filesystem::path& path, double radius_m,
                                                const Ellipsoid& ellipsoid);

}  // namespace terrella
