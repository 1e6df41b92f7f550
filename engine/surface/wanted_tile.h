#pragma once

#include "tiles/tile_grid.h"

namespace terrella {

/// A tile that the view wants, and its priority.
struct WantedTile {
  TileId id;
  double priority = 0.0;  ///< larger first: coarse before fine, then large on the screen
  bool operator==(const WantedTile&) const = default;
};

}  // namespace terrella
