#pragma once

#include <cmath>

#include "geo/coordinates.h"

/// Arithmetic of longitudes, which wrap at 360°. Exact except for the rounding of one subtraction. thread: any
namespace terrella {

/// Returns the degrees from `west_deg` eastward to `lon_deg`, [0, 360].
[[nodiscard]] inline double degrees_east(double lon_deg, double west_deg) {
  const double east = lon_deg - west_deg;
  return east - 360.0 * std::floor(east / 360.0);
}

/// Returns the width of a rectangle, eastward from its west side to its east side, in degrees, [0, 360].
[[nodiscard]] inline double width_deg(const GeoRect& rect) {
  const double width = rect.east.deg() - rect.west.deg();
  return width < 0.0 ? width + 360.0 : width;
}

/// True if the longitudes of a rectangle overlap or touch the `wide_deg` degrees eastward from `west_deg`.
[[nodiscard]] inline bool meets_longitudes(const GeoRect& rect, double west_deg, double wide_deg) {
  const double width = width_deg(rect), from = degrees_east(west_deg, rect.west.deg());
  return width >= 360.0 || from <= width || from + wide_deg >= 360.0;
}

}  // namespace terrella
