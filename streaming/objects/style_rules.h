#pragma once

#include <nlohmann/json.hpp>

#include "streaming/objects/feature_style.h"

namespace terrella {

/// The checked expressions of a style, by the names of simplestyle.
struct FeatureStyle::Rules {
  nlohmann::json properties;
};

/// Returns a feature's properties with those of a style in their place: null where an expression has no value.
/// thread: any
[[nodiscard]] nlohmann::json applied(const FeatureStyle& style, const nlohmann::json& fields);

}  // namespace terrella
