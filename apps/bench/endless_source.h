#pragma once

#include <memory>

#include "tiles/tile_source.h"

namespace terrella::bench {

/// A planet of waves that has tiles at every level to 18, made when they are read: what a flight down to a street
/// needs, and no disk holds. A level shows the waves that its texels can, so that tiles of different levels show the
/// same planet; PNG tiles of 256 pixels, WorldCRS84Quad's grid.
[[nodiscard]] std::unique_ptr<TileSource> make_endless_source();

}  // namespace terrella::bench
