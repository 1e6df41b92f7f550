#pragma once

#include <cstdint>

#include "streaming/cut/strip.h"

namespace terrella {

/// Number of squeezed tiles that a strip gives; 0 unless its row is reduced (tiles/tile_grid.h).
[[nodiscard]] std::int64_t squeezed_tiles(const Strip& strip);

/// Squeezed tile x of a strip, as a strip of one tile. Each pixel is the mean of the 2^squeeze pixels that it spans,
/// with colours weighted by alpha. Beyond the strip the pixels wrap round the planet. thread: any
[[nodiscard]] Strip squeezed_tile(const Strip& strip, std::int64_t x);

}  // namespace terrella
