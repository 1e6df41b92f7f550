#pragma once

#include <optional>
#include <string>

#include "geo/camera.h"
#include "view/ground.h"

namespace terrella {

/// "46.02100° N   7.74900° E"; `step_deg`, what one pixel covers, decides the decimals (0 to 7). thread: any
[[nodiscard]] std::string place_text(const Geodetic& place, double step_deg);
/// "12 m", "3.4 km", "384,000 km": three significant digits.
[[nodiscard]] std::string length_text(double length_m);

/// "12 m²", "3.4 km²", "384,000 km²".
[[nodiscard]] std::string area_text(double area_m2);

/// A bar whose length on the ground is a round number.
struct ScaleBar {
  double length_m;
  double width_px;
};
/// The longest bar of 1, 2 or 5 times a power of ten that is at most `most_px` wide at the picture's centre, across the
/// line of sight; nothing if the centre shows no ground.
[[nodiscard]] std::optional<ScaleBar> scale_bar(const View& view, const Ground& ground, double most_px);

/// Degrees of arc that a pixel at the picture's centre covers; at least what it covers straight below the eye.
[[nodiscard]] double pixel_step_deg(const View& view, const Ground& ground);

/// "LAT,LON,ALT,HEADING,PITCH,FOV" as --camera takes it; reads back as the same camera to the last bits.
[[nodiscard]] std::string camera_text(const Camera& camera);

}  // namespace terrella
