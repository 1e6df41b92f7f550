#pragma once

#include <memory>

#include "tiles/tile_source.h"

namespace terrella::bench {

/// Waves of whole numbers from `low` to `low + 255 * step` over the whole planet, level 0 to 7: as heights or other
/// numbers. thread: any
[[nodiscard]] std::shared_ptr<TileSource> wave_numbers(double low, double step, const NumberInfo& info);
/// The waves of wave_numbers(0, 1) as pictures in the colours of viridis.
[[nodiscard]] std::shared_ptr<TileSource> wave_pictures();

}  // namespace terrella::bench
