#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "base/result.h"
#include "geo/map_plane.h"

namespace terrella {

/// A GeoJSON text as an object with a `type`. `where` begins the error, which says where the text is wrong. thread: any
[[nodiscard]] Result<nlohmann::json> parse_geojson(std::string_view text, const std::string& where);
/// The bytes of a file of at most kMaxGeojsonBytes as text.
[[nodiscard]] Result<std::string> read_geojson_text(const std::filesystem::path& path);

/// The `type` of an object; empty if it has none.
[[nodiscard]] std::string geojson_type(const nlohmann::json& object);
/// "feature 3 ("Alps")": how an error names one, counted from 1, with its name or else its id.
[[nodiscard]] std::string feature_name(const nlohmann::json& feature, std::size_t index);
/// Longitude and latitude of a position; finite, |longitude| ≤ 540, |latitude| ≤ 90.
[[nodiscard]] Result<MapPoint> geojson_position(const nlohmann::json& position);

}  // namespace terrella
