#pragma once

#include <memory>
#include <string>

#include "base/result.h"
#include "geo/ellipsoid.h"
#include "tiles/tile_source.h"

namespace terrella {

/// An angle of the ground, degrees.
enum class GroundAngle {
  slope,  ///< from level ground, 0 to 90
  aspect  ///< the direction that the slope faces, clockwise from north, 0 to 360; level ground has none
};

/// Angles of the ground of heights, as tiles of numbers of the same grid. A texel has the angle of the 3x3 texels
/// around it (B. Horn, "Hill shading and the reflectance map", 1981, as gdaldem), by the metres that
/// texels have on `figure` at its row. Coarser levels have the gentler slopes of their coarser heights. A neighbour
/// without data counts as the texel itself. Fails if the values are no lengths, or if the tiles come from a server one
/// by one: a slope needs nine of them. `name` names the heights in errors. thread: any
[[nodiscard]] Result<std::shared_ptr<TileSource>> slope_tiles(std::shared_ptr<TileSource> heights, GroundAngle angle,
                                                              const Ellipsoid& figure, const std::string& name);

}  // namespace terrella
