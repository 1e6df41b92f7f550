#pragma once

#include <optional>
#include <string>

#include "base/utc_time.h"
#include "geo/camera.h"
#include "view/ground.h"

namespace terrella {

/// Formats a position, for example "46.02100° N   7.74900° E". `step_deg`, the width of a pixel, sets the number of
/// decimals (0 to 7).
[[nodiscard]] std::string place_text(const Geodetic& place, double step_deg);

/// Units of lengths and areas that the user reads: metres and kilometres, feet and statute miles, or metres and
/// nautical miles. thread: any, for all of this header
enum class LengthUnits { metric, imperial, nautical };
/// Formats a length with three significant digits: "12 m", "3.4 km", "384,000 km"; "650 ft", "2.11 mi"; "1.84 NM".
[[nodiscard]] std::string length_text(double length_m, LengthUnits units = LengthUnits::metric);
/// Formats a height over the ellipsoid in whole metres or feet: "4,478 m", "14,692 ft".
[[nodiscard]] std::string height_text(double height_m, LengthUnits units = LengthUnits::metric);
/// Formats an area with three significant digits: "12 m²", "3.4 km²"; "129 ft²", "1.31 mi²"; "0.99 NM²".
[[nodiscard]] std::string area_text(double area_m2, LengthUnits units = LengthUnits::metric);

/// Formats a time, for example "2026-06-21 12:00 UTC".
[[nodiscard]] std::string time_text(UtcTime time);

/// A bar with a round length on the ground.
struct ScaleBar {
  double length_m;
  std::string text;  ///< the length, in round units
  double width_px;
};
/// Returns the longest bar of 1, 2 or 5 times a power of ten units that is at most `most_px` wide. The bar lies at the
/// picture's centre, across the line of sight. Returns nullopt if the centre shows no ground.
[[nodiscard]] std::optional<ScaleBar> scale_bar(const View& view, const Ground& ground, double most_px,
                                                LengthUnits units = LengthUnits::metric);

/// Degrees of arc covered by a pixel at the picture's centre, at least those of a pixel straight below the eye.
[[nodiscard]] double pixel_step_deg(const View& view, const Ground& ground);

}  // namespace terrella
