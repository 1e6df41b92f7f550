#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "geo/body.h"
#include "geo/camera.h"
#include "tiles/tile_grid.h"

namespace terrella {

/// Reads flights from GeoJSON: LineStrings or Features of LineStrings. The third coordinates are heights over the
/// ellipsoid in metres. A Feature's properties may set `pitch`, `heading` and `fov` in degrees, as in --camera. By
/// default the eye looks straight down, with north up and a 40° field of view. Each Feature is a separate flight. The
/// error begins with `where`. thread: any
[[nodiscard]] Result<std::vector<std::vector<Camera>>> parse_flight(std::string_view text, const std::string& where);
[[nodiscard]] Result<std::vector<std::vector<Camera>>> read_flight(const std::filesystem::path& path);

/// Body, tile grid and window size for a flight.
struct FlightView {
  Body body;
  TileGrid grid;
  Viewport size;
};

/// Interpolates the camera between two positions of a flight, t in [0, 1]. The eye follows the great circle, and the
/// logarithm of its height is interpolated. The view direction is that of `a`. thread: any
[[nodiscard]] Camera camera_between(const Camera& a, const Camera& b, double t);

/// Lists the tiles that the viewer requests along the flights, and all their ancestors, without duplicates. Views are
/// sampled every 20th of the visible extent, so that hardly any tile is skipped. camera_between() interpolates the eye.
/// Memory grows with the number of tiles. thread: any
[[nodiscard]] std::vector<TileId> tiles_along(const std::vector<std::vector<Camera>>& ways, const FlightView& view);

}  // namespace terrella
