#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace terrella {

/// Metres in a unit as files name it: "m", "metre", "ft", "US survey foot", "cm", "km", … An empty name counts as
/// metres. None for a name that is no known length. thread: any
[[nodiscard]] std::optional<double> metres_of_unit(std::string_view unit);

/// Returns the reason why numbers in this unit are no heights, and a cure. thread: any
[[nodiscard]] std::string no_length(std::string_view unit);

}  // namespace terrella
