#pragma once

#include <optional>
#include <vector>

#include "streaming/warp/filter/taps.h"
#include "streaming/warp/map/patch.h"

namespace terrella {

/// The columns and rows of a tile in pixels of the source; NaN where the tile has none.
struct TileLines {
  std::vector<Line> columns, rows;
};

/// Finds out if the source column depends on the tile's column only, and the row on the row only. thread: any
[[nodiscard]] std::optional<TileLines> find_lines(const std::vector<Patch>& patches, int tile_px);

}  // namespace terrella
