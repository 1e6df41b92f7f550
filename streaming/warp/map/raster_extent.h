#pragma once

#include <optional>

#include "streaming/warp/map/ground_map.h"

namespace terrella {

/// The area that a raster covers: row latitudes, and longitudes from west to east; east may exceed 180.
struct RasterExtent {
  double west_deg = -180.0, south_deg = -90.0, east_deg = 180.0, north_deg = 90.0;
  [[nodiscard]] bool goes_round() const { return east_deg - west_deg >= 360.0; }
};

/// Finds the extent through PROJ, from points along the edges and inside. A pole on the raster gives all longitudes.
/// None if no point of the raster has a place. thread: one at a time for a map
[[nodiscard]] std::optional<RasterExtent> raster_extent(const GroundMap& map, double width_px, double height_px);

/// The pixels per degree, larger of longitude and latitude, in the middle of the raster; none if no part of it has a
/// place. thread: one at a time for a map
[[nodiscard]] std::optional<double> pixels_per_degree(const GroundMap& map, double width_px, double height_px);

}  // namespace terrella
