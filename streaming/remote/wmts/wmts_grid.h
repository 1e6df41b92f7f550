#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "streaming/remote/remote_tile_set.h"
#include "streaming/remote/wmts/wmts_matrix_set.h"

namespace terrella {

/// A tile matrix set on a TileGrid. Its levels are the set's matrices, coarsest first.
struct WmtsGrid {
  TileGrid grid;  ///< bounds: area in which the matrices, or the layer's limits, have tiles
  std::vector<std::string> level_names;
  std::vector<TileShift> shifts;  ///< empty: none
  std::string body;
  std::optional<CrsSquare> square = {};  ///< set: the grid is `projected`
};

/// Finds the grid of a matrix set: geodetic, in Web Mercator, or `projected` in any other system (wmts_projected.h).
/// Angles come from the scale denominators: a WMTS pixel is 0.28 mm and a degree 6378137·π/180 m, whatever the body
/// (OGC 07-057r7, 6.1). If the matrices then do not cover the planet, but do with the radius of the body (`body`, else
/// that of the reference system), the server counts with that radius.
/// Matrices whose corner is no whole number of tiles from (-180°, 90°) are left out if a finer matrix has a fitting
/// corner. Matrices of EPSG:3857 make a grid in Web Mercator if their tiles are the usual web tiles. `bounds`: the
/// layer's area, degrees. The error is the reason alone. thread: any
[[nodiscard]] Result<WmtsGrid> grid_of(const WmtsMatrixSet& set, const std::vector<WmtsLimits>& limits,
                                       const std::optional<std::string>& body, const std::optional<GeoRect>& bounds);

}  // namespace terrella
