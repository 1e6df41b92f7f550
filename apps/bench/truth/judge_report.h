#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "apps/bench/truth/judge.h"

namespace terrella::truth {

/// Formats a line per zone in the picture: name, RMS, maximum, bias, pixels; then the limb.
[[nodiscard]] std::string as_table(const Judgement& judgement);
/// Formats {"zones": {NAME: {"rms", "max", "bias", "pixels"}}, "limb": {"pixels", "off"}, "outside": {...}}
[[nodiscard]] nlohmann::json as_json(const Judgement& judgement);

}  // namespace terrella::truth
