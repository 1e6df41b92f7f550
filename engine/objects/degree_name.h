#pragma once

#include <string>

namespace terrella {

/// Returns the label of a parallel or a meridian, "30° N" or "0.25° W", with as many decimals as the spacing of the
/// lines needs. 0° and 180° have no letter. thread: any
[[nodiscard]] std::string degree_name(double deg, double spacing_deg, const char* positive, const char* negative);

}  // namespace terrella
