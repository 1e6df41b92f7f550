#pragma once

#include <optional>
#include <string>

#include "geo/coordinates.h"
#include "streaming/georeference/crs.h"
#include "streaming/remote/wmts/wmts_matrix_set.h"

namespace terrella {

/// The system of a matrix set.
struct WmtsSystem {
  const Crs& crs;
  std::string text;     ///< for Crs::open()
  double unit_m = 1.0;  ///< metres in a unit of the system
};

/// True if a set's corners have the northing first. Writers differ, so the boxes decide: the set's BoundingBox begins
/// or ends at the corner, or most of the layer's area (`bounds`, degrees) lies in the tiles in one order alone. Else
/// the order is that of PROJ's definition. thread: any
[[nodiscard]] bool has_northing_first(const WmtsMatrixSet& set, const WmtsSystem& system,
                                      const std::optional<GeoRect>& bounds);

}  // namespace terrella
