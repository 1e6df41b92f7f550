#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "geo/coordinates.h"
#include "streaming/remote/wmts/wmts_axes.h"
#include "streaming/remote/wmts/wmts_grid.h"
#include "streaming/remote/wmts/wmts_matrix_set.h"

namespace terrella {

/// Makes a `projected` grid of a matrix set in any system that PROJ knows. The set's finest matrices become levels, at
/// most as many as a grid has; coarser ones that do not cover the finest, or have tiles of another size, are left out.
/// Matrices that halve and share a corner are a quadtree. Others keep places of their own (CrsSquare::levels).
///
/// TopLeftCorner may have either axis first. The set's BoundingBox decides, else `bounds`, the layer's area in degrees,
/// else PROJ's definition of the system. The error is the reason alone. thread: any
[[nodiscard]] Result<WmtsGrid> projected_grid_of(const WmtsMatrixSet& set, const std::vector<WmtsLimits>& limits,
                                                 const std::optional<GeoRect>& bounds);

/// The same with axes in a known order. thread: any
[[nodiscard]] Result<WmtsGrid> placed_grid_of(const WmtsMatrixSet& set, const std::vector<WmtsLimits>& limits,
                                              const WmtsSystem& system, bool northing_first);

/// Metres in a unit of a system, as scale denominators count them: a degree is that of the WMTS standard. thread: any
[[nodiscard]] double metres_of_axis(const CrsFacts& facts);

}  // namespace terrella
