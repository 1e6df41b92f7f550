#pragma once

#include <filesystem>
#include <string>

#include "streaming/objects/vector_facts.h"

namespace terrella {

/// Describes a vector file for `terrella info`, as lines of text or one JSON object: its layers with their features,
/// coordinate systems, bounds and fields. thread: any
[[nodiscard]] std::string vector_report(const std::filesystem::path& path, const VectorFacts& facts, bool json);

}  // namespace terrella
