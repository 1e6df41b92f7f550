#pragma once

#include <vector>

#include "apps/flight/flight_path.h"
#include "geo/body.h"
#include "geo/camera.h"
#include "tiles/tile_grid.h"

namespace terrella {

/// Body, tile grid and window size for a flight.
struct FlightView {
  Body body;
  TileGrid grid;
  Viewport size;
};

/// Lists the tiles that the viewer requests along the flights, and all their ancestors, without duplicates. Views are
/// sampled every 20th of the visible extent, so that hardly any tile is skipped. Memory grows with the number of tiles.
/// thread: any
[[nodiscard]] std::vector<TileId> tiles_along(const std::vector<FlightPath>& paths, const FlightView& view);

}  // namespace terrella
