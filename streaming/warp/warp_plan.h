#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "streaming/warp/filter/taps.h"
#include "streaming/warp/warp_levels.h"

namespace terrella {

/// Detail of tiles that are coarser than the raster. A level of about the tile's own resolution loses the shortest
/// waves when it is resampled. `full` reads a level that is finer by at least √2, so that the filter does the rest of
/// the reduction: two to four times the pixels. Tiles that are copies of a level's pixels lose nothing and remain
/// copies.
enum class Detail { usual, full };

/// A raster of which tiles are made.
struct WarpFrame {
  std::vector<WarpLevel> levels;
  Detail detail = Detail::usual;
};

/// A block that contributes to a tile.
struct WarpPiece {
  TileId id;          ///< level: index in WarpFrame::levels
  bool core = false;  ///< lies under the tile itself; false: only under the filter's reach beyond
};

/// Patches that are made from one canvas of source pixels.
struct WarpChunk {
  PixelRect64 canvas;
  std::vector<Patch> patches;  ///< in pixels of the level
};

/// Recipe of a tile whose columns are columns of the source, and rows rows.
struct WarpLines {
  PixelRect64 canvas;
  std::vector<LineTaps> columns, rows;  ///< taps count from the canvas' corner
};

/// Recipe of a tile: blocks, source pixels and weights.
struct WarpPlan {
  int tile_px = 0;
  int rows = 0;   ///< rows that lie on the planet; those beyond the south pole repeat the last
  int level = 0;  ///< index in WarpFrame::levels
  std::vector<WarpPiece> pieces;
  std::optional<WarpLines> lines;  ///< none: chunks
  std::vector<WarpChunk> chunks;
};

/// Plans a tile.
/// The level is the coarsest whose pixels are no larger than the tile's, both measured along the meridian, in three
/// quarters of the tile, or a finer one (Detail). Tiles near the poles have more columns than a view needs, so that
/// columns do not count. thread: one at a time for a map
[[nodiscard]] WarpPlan plan_tile(const PixelMap& tile, const WarpFrame& frame);

}  // namespace terrella
