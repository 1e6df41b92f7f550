#pragma once

#include <array>

#include "tiles/tile_grid.h"

namespace terrella {

/// Names of the projections in descriptions of tile sets, in the order of the enumeration.
inline constexpr std::array kProjectionNames = {"equirectangular", "equal-area", "web-mercator", "projected"};

[[nodiscard]] inline const char* projection_name(Projection projection) {
  return kProjectionNames.at(static_cast<std::size_t>(projection));
}

}  // namespace terrella
