#pragma once

#include <istream>
#include <nlohmann/json.hpp>
#include <string_view>

#include "geo/result.h"

namespace terrella {

inline constexpr int kMaxJsonDepth = 64;  ///< lists and objects within each other; no format that is read needs ten

/// Parses JSON text that came from outside. `visit` sees each value as nlohmann::json::parse() shows it to a callback;
/// what it throws comes through. The error says what is wrong, at which byte if that is known, and repeats nothing of
/// the text, which may hold secrets. thread: any
[[nodiscard]] Result<nlohmann::json> parse_json(std::string_view text,
                                                const nlohmann::json::parser_callback_t& visit = nullptr);
[[nodiscard]] Result<nlohmann::json> parse_json(std::istream& text, const nlohmann::json::parser_callback_t& visit);

}  // namespace terrella
