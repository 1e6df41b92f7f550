#pragma once

#include <cstdint>

#include "streaming/cut/strip.h"

namespace terrella {

/// Squeezed tiles that a strip gives: none unless its row is reduced (tiles/tile_grid.h).
[[nodiscard]] std::int64_t squeezed_tiles(const Strip& strip);

/// Squeezed tile x of a strip, as a strip of one tile: each pixel is the mean of the 2^squeeze that it spans, colours
/// weighed by alpha. Beyond the strip it goes on round the planet. thread: any
[[nodiscard]] Strip squeezed_tile(const Strip& strip, std::int64_t x);

}  // namespace terrella
