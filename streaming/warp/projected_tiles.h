#pragma once

#include <memory>
#include <string>

#include "base/result.h"
#include "tiles/tile_source.h"

namespace terrella {

/// Makes a geodetic tile set (warp_grid()) from a stored set in a `projected` grid, local or remote, pictures or
/// heights. The stored tiles are the blocks of a raster (raster_of_tiles()). The error begins with `where`. thread:
/// any; the tiles' as TileSource says
[[nodiscard]] Result<std::unique_ptr<TileSource>> geodetic_of_projected(std::unique_ptr<TileSource> stored,
                                                                        const std::string& where);

}  // namespace terrella
