#pragma once

#include "geo/coordinates.h"

namespace terrella::test {

/// A place by degrees and metres.
inline Geodetic at(double lat_deg, double lon_deg, double height_m = 0.0) {
  return {.lat = Angle::degrees(lat_deg), .lon = Angle::degrees(lon_deg), .height_m = height_m};
}

}  // namespace terrella::test
