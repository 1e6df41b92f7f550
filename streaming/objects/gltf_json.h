#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <span>

#include "base/result.h"

namespace terrella {

/// Parses the JSON of a glTF file; a binary file (.glb) has it in its first chunk. Refuses JSON that would crash
/// TinyGLTF: deeper than kJsonLimits, more than 4 million pieces (JsonBuilder), or chunks beyond the end of the file.
/// Also refuses more nodes than kMaxModelNodes. thread: any
[[nodiscard]] Result<nlohmann::json> gltf_json(std::span<const std::byte> bytes);

}  // namespace terrella
