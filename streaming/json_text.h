#pragma once

#include <istream>
#include <limits>
#include <nlohmann/json.hpp>
#include <string_view>

#include "base/result.h"
#include "streaming/json_builder.h"

namespace terrella {

/// For all JSON that comes from outside. No format that is read needs more than ten lists and objects in each other.
inline constexpr JsonBuilder::Limits kJsonLimits{.depth = 64, .pieces = std::numeric_limits<std::size_t>::max()};

/// Parses JSON text that came from outside; `keep` as JsonBuilder has it. The error says what is wrong, at which byte
/// if that is known, and repeats nothing of the text, which may hold secrets. thread: any
[[nodiscard]] Result<nlohmann::json> parse_json(std::string_view text, JsonBuilder::Limits limits = kJsonLimits);
[[nodiscard]] Result<nlohmann::json> parse_json(std::istream& text, JsonBuilder::Limits limits, JsonBuilder::Keep keep);

}  // namespace terrella
