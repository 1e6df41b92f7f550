#pragma once

#include <cmath>
#include <cstdio>
#include <string>

namespace terrella {

/// Returns the label of a parallel or a meridian, "30° N" or "0.25° W", with as many decimals as the spacing of the
/// lines needs. 0° and 180° have no letter. thread: any
[[nodiscard]] inline std::string degree_name(double deg, double spacing_deg, const char* positive,
                                             const char* negative) {
  const int decimals = spacing_deg >= 1.0 ? 0 : static_cast<int>(std::ceil(-std::log10(spacing_deg) - 1e-9));
  char text[40];
  const bool plain = deg == 0.0 || std::abs(deg) == 180.0;
  std::snprintf(text, sizeof text, "%.*f°%s%s", decimals, std::abs(deg), plain ? "" : " ",
                plain ? "" : (deg < 0.0 ? negative : positive));
  return text;
}

}  // namespace terrella
