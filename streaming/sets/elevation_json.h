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

}  // namespace terrella
