#pragma once

#include <nlohmann/json_fwd.hpp>

#include "streaming/objects/object_style.h"

namespace terrella {

/// Whether a FeatureCollection's "metadata" are those of the feeds of the US Geological Survey's earthquake catalogue
/// (earthquake.usgs.gov/earthquakes/feed/v1.0/geojson.php), whose third coordinate is a depth in kilometres. thread:
/// any
[[nodiscard]] bool is_quake_catalogue(const nlohmann::json& metadata);

/// Makes an earthquake a sphere whose radius grows with its magnitude (4 km · 10^(M/4): 4 km at 0, 40 km at 4), in a
/// colour that says its depth (red at the surface, yellow at 100 km, green, blue from 350 km), where the properties do
/// not say otherwise. Titles, which all of them have, make no labels.
void style_quake(const nlohmann::json& feature, ObjectStyle& style);

}  // namespace terrella
