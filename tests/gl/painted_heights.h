#pragma once

#include <functional>
#include <memory>

#include "tiles/tile_source.h"

namespace terrella::test {

/// Metres at a place by latitude and longitude in radians, within ±8000. thread: worker
using HeightPaint = std::function<double(double lat_rad, double lon_rad)>;

/// Heights as 16-bit tiles, painted when they are asked for, in quarters of a metre.
[[nodiscard]] std::shared_ptr<TileSource> painted_heights(const TileGrid& grid, HeightPaint paint);

}  // namespace terrella::test
