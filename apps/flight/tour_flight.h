#pragma once

#include <vector>

#include "apps/flight/flight_path.h"
#include "streaming/objects/vector/kml_tours.h"

namespace terrella {

/// The flights of tours over the Earth: one for each part of a tour between two jumps. The Sun follows the times of the
/// views if each view of a part has one. thread: any
[[nodiscard]] std::vector<FlightPath> flights_of(const std::vector<KmlTour>& tours);

}  // namespace terrella
