#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "streaming/warp/block.h"
#include "streaming/warp/warp_levels.h"

namespace terrella {

/// Returns the pixels of a block, or null if they are transparent. A failure ends the tile.
using BlockAt = std::function<Result<std::shared_ptr<const Block>, TileFailure>(const TileId& block)>;

/// Source pixels side by side, as weighted sums: colours times alpha, and alpha, in [0, 255]; or a number and 1. A
/// missing pixel is 0. Pixels beyond the source's edge repeat the edge's.
template <std::size_t kChannels>
struct Canvas {
  PixelRect64 rect;
  std::vector<float> sums;

  [[nodiscard]] const float* at(std::int64_t column, std::int64_t row) const {
    return sums.data() + static_cast<std::size_t>(row * rect.width() + column) * kChannels;
  }
  [[nodiscard]] float* at(std::int64_t column, std::int64_t row) {
    return sums.data() + static_cast<std::size_t>(row * rect.width() + column) * kChannels;
  }
};
using ColourCanvas = Canvas<4>;
using NumberCanvas = Canvas<2>;

/// Reads the blocks under a rectangle of a level.
template <std::size_t kChannels>
[[nodiscard]] Result<Canvas<kChannels>, TileFailure> read_canvas(const WarpLevel& level, int index,
                                                                 const PixelRect64& rect, const BlockAt& block_at);

}  // namespace terrella
