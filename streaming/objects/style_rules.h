#pragma once

#include <nlohmann/json.hpp>
#include <optional>

#include "streaming/objects/feature_style.h"

namespace terrella {

/// The checked expressions of a style, by the names of simplestyle.
struct FeatureStyle::Rules {
  nlohmann::json properties;
};

/// Returns the number that a field means in expressions: a number, or a text that is one. thread: any
[[nodiscard]] std::optional<double> number_of(const nlohmann::json& value);

/// Returns a feature's properties with those of a style in their place: null where an expression has no value.
/// thread: any
[[nodiscard]] nlohmann::json applied(const FeatureStyle& style, const nlohmann::json& fields);

}  // namespace terrella
