#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "base/result.h"
#include "geo/map_plane.h"

namespace terrella {

/// Parses GeoJSON text that must be an object with a `type`. The error begins with `where` and gives the place of the
/// fault in the text. thread: any
[[nodiscard]] Result<nlohmann::json> parse_geojson(std::string_view text, const std::string& where);
/// Reads a file of at most kMaxGeojsonBytes as text.
[[nodiscard]] Result<std::string> read_geojson_text(const std::filesystem::path& path);

/// The `type` of an object; empty if it has none.
[[nodiscard]] std::string geojson_type(const nlohmann::json& object);
/// Calls `take` for each geometry of a document that is a geometry, a Feature or a FeatureCollection, and for the parts
/// of its GeometryCollections. Skips features without a geometry. The error names the feature.
[[nodiscard]] Status for_each_geometry(const nlohmann::json& document,
                                       const std::function<Status(const nlohmann::json& geometry)>& take);
/// Calls `take` for each entry of an object's list.
[[nodiscard]] Status for_each_entry(const nlohmann::json& object, const char* list,
                                    const std::function<Status(const nlohmann::json& entry)>& take);
/// Name of a feature in errors: "feature 3 ("Alps")". Counts from 1, with the feature's name or else its id.
[[nodiscard]] std::string feature_name(const nlohmann::json& feature, std::size_t index);
/// Longitude and latitude of a position: finite, |longitude| ≤ 540, |latitude| ≤ 90.
[[nodiscard]] Result<MapPoint> geojson_position(const nlohmann::json& position);

}  // namespace terrella
