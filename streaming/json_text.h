#pragma once

#include <istream>
#include <limits>
#include <nlohmann/json.hpp>
#include <string_view>

#include "base/result.h"
#include "streaming/json_builder.h"

namespace terrella {

/// Limits for all JSON from outside. No supported format needs more than ten nested lists and objects.
inline constexpr JsonBuilder::Limits kJsonLimits{.depth = 64, .pieces = std::numeric_limits<std::size_t>::max()};

/// Parses JSON text from outside; `keep` works as in JsonBuilder. The error gives the fault and, if known, its byte.
/// The error repeats nothing of the text, which may hold secrets. thread: any
[[nodiscard]] Result<nlohmann::json> parse_json(std::string_view text, JsonBuilder::Limits limits = kJsonLimits);
[[nodiscard]] Result<nlohmann::json> parse_json(std::istream& text, JsonBuilder::Limits limits, JsonBuilder::Keep keep);

}  // namespace terrella
