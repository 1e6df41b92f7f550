#include "streaming/warp/map/pixel_map.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace terrella {
namespace {

/// Distance from the edges of a tile at which its edges are looked up: the map may end at ±180° and at the poles.
constexpr double kInset_px = 1e-6;

}  // namespace

PixelMap map_of_tile(const GroundMap& map, const TileGrid& grid, const TileId& id) {
  const TileBounds bounds = tile_bounds(grid, id);
  const double side = grid.tile_px;
  const double step_deg = tile_span_deg(grid, id.level) / side;
  const auto place = [bounds, side, step_deg](const CrsPoint& at) {
    const double x = std::clamp(at.x, kInset_px, side - kInset_px), y = std::clamp(at.y, kInset_px, side - kInset_px);
    return RowPlace{bounds.west_deg + x * step_deg,
                    std::max(bounds.north_deg - y * step_deg, -90.0 + kInset_px * step_deg)};
  };
  PixelMap tile{
      .tile_px = grid.tile_px,
      .rows = static_cast<int>(std::clamp(std::ceil((bounds.north_deg + 90.0) / step_deg - kInset_px), 0.0, side)),
      .pixel_deg = step_deg,
      .pixels = {},
      .on_ground = {}};
  tile.pixels = [&map, place](std::span<const CrsPoint> places_px, std::span<CrsPoint> out) {
    std::vector<RowPlace> places(places_px.size());
    std::ranges::transform(places_px, places.begin(), place);
    map.pixels(places, out);
  };
  tile.on_ground = [bounds, step_deg](const Jacobian& pixels, double, double y) {
    const double row_deg = bounds.north_deg - y * step_deg;
    const double cosine = std::max(std::cos(row_deg * std::numbers::pi / 180.0), 1e-3);
    return GroundScale{{pixels.u_x / cosine, pixels.u_y, pixels.v_x / cosine, pixels.v_y}, cosine};
  };
  return tile;
}

}  // namespace terrella
