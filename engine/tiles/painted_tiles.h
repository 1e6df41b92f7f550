#pragma once

#include <functional>
#include <memory>

#include "base/result.h"
#include "codecs/image.h"
#include "tiles/tile_source.h"

namespace terrella {

/// Makes the pixels of one tile: tile_px a side, rows from the north-west corner. May take long. A picture of another
/// size, or with another number of bytes, makes the tile broken. An exception of any type makes the tile a failed one.
/// thread: worker, several at once
using TilePainter = std::function<Result<Image, TileFailure>(const TileId&)>;

/// Makes a set of tiles that an application paints itself, from raw pixels without a codec. Null if `paint` is empty.
/// A grid out of its ranges has no tiles, and Globe::add_imagery() refuses it. thread: any
[[nodiscard]] std::shared_ptr<TileSource> painted_tiles(const TileGrid& grid, TilePainter paint);

}  // namespace terrella
