#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "tiles/tile_source.h"

namespace terrella::bench {

/// A PNG of one colour, 256 pixels a side.
[[nodiscard]] const std::vector<std::byte>& flat_tile();

/// A tile set of levels 0 to `max_level`, at most 24, whose tiles are all flat_tile(). Tiles cost next to nothing, so
/// that the cost of the engine shows.
[[nodiscard]] std::shared_ptr<TileSource> make_flat_source(int max_level);

}  // namespace terrella::bench
