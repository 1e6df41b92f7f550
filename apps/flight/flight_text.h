#pragma once

#include <span>
#include <string>

#include "apps/flight/flight_path.h"

namespace terrella {

/// Writes flights as GeoJSON, a Feature for each with its keyframes and their times. parse_flight() reads the same
/// flights, to the rounding of their angles. thread: any
[[nodiscard]] std::string flight_text(std::span<const FlightPath> flights);

}  // namespace terrella
