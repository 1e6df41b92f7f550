#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "streaming/json_fields.h"
#include "tiles/tile_source.h"

namespace terrella {

/// Reads the field "elevation" of a tileset.json or a source description (streaming/README.md); none if missing.
/// `fields` reads `object` and receives the error. thread: any
[[nodiscard]] std::optional<NumberInfo> read_elevation(const nlohmann::json& object, JsonFields& fields,
                                                       const std::string& where);

/// Numbers in colours by the name of their encoding, as MapLibre's "raster-dem" sources have it: "terrain-rgb" or
/// "mapbox", metres = -10000 + 0.1 · (R · 65536 + G · 256 + B); "terrarium", metres = R · 256 + G + B / 256 - 32768.
/// None for another name. thread: any
[[nodiscard]] std::optional<NumberInfo> rgb_encoding(const std::string& name);

}  // namespace terrella
