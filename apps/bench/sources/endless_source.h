#pragma once

#include <memory>

#include "tiles/tile_source.h"

namespace terrella::bench {

/// Creates a synthetic planet of waves with tiles at levels 0 to 18, made on demand. Flights down to a street need more
/// tiles than a disk holds. Each level shows the waves that its texels can resolve, so that all levels show the same
/// planet. Tiles are PNG with 256 pixels a side, on WorldCRS84Quad's grid.
[[nodiscard]] std::unique_ptr<TileSource> make_endless_source();

}  // namespace terrella::bench
