#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <span>

#include "base/result.h"

namespace terrella {

/// The JSON of a glTF file, which a binary one (.glb) holds in its first chunk. Refuses what TinyGLTF would not
/// survive: JSON nested deeper than kJsonLimits or of more than 4 million pieces (JsonBuilder), and chunks that run
/// over the file; and more nodes than kMaxModelNodes. thread: any
[[nodiscard]] Result<nlohmann::json> gltf_json(std::span<const std::byte> bytes);

}  // namespace terrella
