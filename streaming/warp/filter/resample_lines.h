#pragma once

#include <optional>
#include <span>
#include <vector>

#include "streaming/warp/canvas.h"
#include "streaming/warp/warp_plan.h"

namespace terrella {

/// True if each column and row of the tile is one of the source, side by side.
[[nodiscard]] bool are_copies(const WarpLines& lines);

/// Copies the pixels of a plan for which are_copies() is true. Returns a failure of `block_at`. thread: any
template <class Tile>
[[nodiscard]] std::optional<TileFailure> copy_lines(const WarpPlan& plan, const WarpLevel& level,
                                                    const BlockAt& block_at, typename Tile::Pixels& to);

/// Sums the rows of a canvas, then its columns. Taps count from the canvas's corner. `to` has a pixel for each column
/// of each row; pixels beside the source stay as they are. thread: any
template <class Tile>
void resample_lines(const std::vector<LineTaps>& columns, std::span<const LineTaps> rows,
                    const Canvas<Tile::kChannels>& canvas, typename Tile::Pixels& to);

}  // namespace terrella
