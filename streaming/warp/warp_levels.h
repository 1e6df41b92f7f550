#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "streaming/raster/raster_source.h"
#include "streaming/warp/map/tile_patches.h"

namespace terrella {

/// A level that tiles are made of: a stored level, or a stored level whose blocks are reduced as they are decoded.
struct WarpLevel {
  int stored = 0;    ///< index in RasterInfo::levels
  int halvings = 0;  ///< > 0: blocks are reduced by 2^halvings
  RasterArea area;   ///< in pixels of this level
  int block_width_px = 0, block_height_px = 0;
  std::int64_t blocks_across = 0, blocks_down = 0;
  Affine from_finest;        ///< from pixels of the finest level to pixels of this level
  double pixel_size = 1.0;   ///< pixels of the finest level in a pixel of this level, along a side
  bool has_parents = false;  ///< the level before shows the same blocks two by two

  /// Columns of pixels until they repeat; in a raster that is not cyclic, all of them.
  [[nodiscard]] std::int64_t columns() const;
  [[nodiscard]] std::int64_t rows() const;
};

/// Levels that a raster does not have: none, or reduced ones, between those that it has and down to about a tile.
enum class Overviews { stored, made };
/// The levels of a raster, the coarsest first. thread: any
[[nodiscard]] std::vector<WarpLevel> warp_levels(const RasterInfo& raster, const std::optional<CrsPoint>& turn_px,
                                                 int tile_px, Overviews overviews);

/// A rectangle of whole pixels of a level, which may go beyond its edges.
struct PixelRect64 {
  std::int64_t u0 = 0, v0 = 0, u1 = 0, v1 = 0;  ///< u1 and v1 are excluded
  [[nodiscard]] std::int64_t width() const { return u1 - u0; }
  [[nodiscard]] std::int64_t height() const { return v1 - v0; }
  [[nodiscard]] bool empty() const { return u1 <= u0 || v1 <= v0; }
};

/// The part of a rectangle that lies in one block.
struct BlockPart {
  TileId block;                     ///< level: index in warp_levels()
  int x = 0, y = 0;                 ///< first pixel in the block
  std::int64_t to_x = 0, to_y = 0;  ///< its place in the rectangle
  int width = 0, height = 0;
};
/// Calls for the part of each block that lies in the rectangle. Columns of a cyclic level go round. Pixels beyond the
/// level are in no part.
void for_each_part(const WarpLevel& level, int index, const PixelRect64& rect,
                   const std::function<void(const BlockPart&)>& call);

}  // namespace terrella
