#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "base/result.h"
#include "streaming/preload/region.h"

namespace terrella {

/// A longer file is refused before it is parsed.
inline constexpr std::size_t kMaxGeojsonBytes = 64UL << 20;
/// A region with more points than this, after edges are divided (great_circle.h), is refused.
inline constexpr std::size_t kMaxRegionPoints = 4'000'000;

/// Reads the polygons of GeoJSON text (RFC 7946): Polygon, MultiPolygon, and Feature, FeatureCollection and
/// GeometryCollection of polygons, with holes. Skips features without a geometry. great_circle.h defines edges, ±180°
/// and poles. Ignores third coordinates. The error begins with `where` (a path) and names the feature, counted from 1.
/// thread: any
[[nodiscard]] Result<Region> parse_geojson_region(std::string_view text, const std::string& where);
/// Reads a region from a file.
[[nodiscard]] Result<Region> read_geojson_region(const std::filesystem::path& path);

}  // namespace terrella
