#pragma once

#include <memory>
#include <string>

#include "base/result.h"
#include "geo/ellipsoid.h"
#include "tiles/tile_source.h"

namespace terrella {

/// The slopes of heights, in degrees from level ground, as tiles of numbers of the same grid. A texel has the slope of
/// the 3x3 texels around it (B. Horn, "Hill shading and the reflectance map", 1981, as gdaldem), by the metres that
/// texels have on `figure` at its row. Coarser levels have the gentler slopes of their coarser heights. A neighbour
/// without data counts as the texel itself. Fails if the values are no lengths, or if the tiles come from a server one
/// by one: a slope needs nine of them. `name` names the heights in errors. thread: any
[[nodiscard]] Result<std::shared_ptr<TileSource>> slope_tiles(std::shared_ptr<TileSource> heights,
                                                              const Ellipsoid& figure, const std::string& name);

}  // namespace terrella
