#pragma once

#include <nlohmann/json_fwd.hpp>

#include "streaming/objects/object_style.h"

namespace terrella {

/// True if the "metadata" of a FeatureCollection are those of the US Geological Survey's earthquake feeds
/// (earthquake.usgs.gov/earthquakes/feed/v1.0/geojson.php). The third coordinate of these feeds is a depth in
/// kilometres. thread: any
[[nodiscard]] bool is_quake_catalogue(const nlohmann::json& metadata);

/// Styles an earthquake as a sphere, unless the properties say otherwise. Its radius grows with magnitude M: 4 km ·
/// 10^(M/4), which is 4 km at 0 and 40 km at 4. Its colour shows depth: red at the surface, yellow at 100 km, green,
/// blue at 350 km, violet from 600 km. Titles make no labels, because every earthquake has one.
void style_quake(const nlohmann::json& feature, ObjectStyle& style);

}  // namespace terrella
