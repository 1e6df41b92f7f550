#pragma once

#include <cstdint>

#include "geo/tile_grid.h"

namespace terrella {

/// Names a layer of one globe, never a second one of that globe. `none` is no layer.
enum class LayerId : std::uint64_t { none = 0 };

/// How an image layer is shown; can change from frame to frame.
struct ImageLook {
  bool shown = true;
  double opacity = 1.0;           ///< [0, 1]; goes with the alpha of the layer's own tiles
  int min_level = 0;              ///< where a view asks for coarser tiles than these the layer is not drawn
  int max_level = kMaxTileLevel;  ///< finer tiles are not asked for: these are magnified
};

}  // namespace terrella
