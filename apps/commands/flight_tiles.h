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

/// Reads the way of an eye: a GeoJSON LineString, or Feature of one, whose third coordinates are heights over the
/// ellipsoid, metres. The Feature's properties may say `pitch`, `heading` and `fov`, degrees, as for --camera; else the
/// eye looks straight down with north up, 40° high. Several Features are several flights. `where` begins the error.
/// thread: any
[[nodiscard]] Result<std::vector<std::vector<Camera>>> parse_flight(std::string_view text, const std::string& where);
[[nodiscard]] Result<std::vector<std::vector<Camera>>> read_flight(const std::filesystem::path& path);

/// What a window shows on the way.
struct FlightView {
  Body body;
  TileGrid grid;
  Viewport size;
};

/// The eye between two positions of a way, t in [0, 1]: along the great circle, the height by its logarithm; looking as
/// at the first. thread: any
[[nodiscard]] Camera camera_between(const Camera& a, const Camera& b, double t);

/// The tiles that the viewer asks for along the ways, with all their ancestors, each once. Between two positions the
/// eye goes along the great circle, its height by its logarithm; looked at often enough that next to nothing is passed
/// unseen: every 20th of what the picture shows. Memory goes with the number of tiles. thread: any
[[nodiscard]] std::vector<TileId> tiles_along(const std::vector<std::vector<Camera>>& ways, const FlightView& view);

}  // namespace terrella
