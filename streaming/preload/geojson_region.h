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
/// More pieces than this, after edges were divided (great_circle.h), are refused.
inline constexpr std::size_t kMaxRegionPoints = 4'000'000;

/// The polygons of GeoJSON text (RFC 7946): Polygon, MultiPolygon, Feature, FeatureCollection and GeometryCollection of
/// them, with holes; features without a geometry are passed over. Edges, ±180° and poles as great_circle.h says; third
/// coordinates are ignored. `where` (a path) begins the error, which names the feature, counted from 1. thread: any
[[nodiscard]] Result<Region> parse_geojson_region(std::string_view text, const std::string& where);
/// The same from a file.
[[nodiscard]] Result<Region> read_geojson_region(const std::filesystem::path& path);

}  // namespace terrella
