#include "apps/open_scene/bounds_view.h"

#include <algorithm>
#include <cmath>

#include "geo/body.h"
#include "geo/longitudes.h"
#include "streaming/sets/open_tile_set.h"
#include "streaming/tile_lister.h"
#include "view/view_limits.h"

namespace terrella {
namespace {

constexpr double kMostOfPlanet_deg = 300.0;
constexpr double kRoom = 1.3;         // visible extent relative to that of the bounds
constexpr double kNearest_m = 100.0;  // lowest height, as a single point has no extent

/// Tiles of this width tell a part of the planet well enough.
constexpr double kNarrow_deg = 12.0;
constexpr int kMostTiles = 20'000;

GeoRect bounds_of(const TileGrid& grid, const TileId& least, const TileId& most) {
  const TileBounds first = tile_bounds(grid, least), last = tile_bounds(grid, most);
  const auto latitude = [&grid](double row_deg) { return latitude_of_row(grid, earth().ellipsoid, row_deg); };
  return {.west = Angle::degrees(std::max(-180.0, first.west_deg)),
          .south = latitude(std::max(bottom_row_deg(grid), last.south_deg)),
          .east = Angle::degrees(std::min(180.0, last.east_deg)),
          .north = latitude(std::min(top_row_deg(grid), first.north_deg))};
}

}  // namespace

std::optional<GeoRect> part_with_data(const Url& tile_set, const GeoRect& bounds) {
  const auto stated = if_a_part(bounds);
  if (stated || tile_set.empty()) return stated;
  const auto source = open_stored_tile_set(tile_set.with_secrets());
  auto* const lister = source ? dynamic_cast<TileLister*>(source->get()) : nullptr;
  if (lister == nullptr || (*source)->info().grid.projection == Projection::projected) return {};
  const TileGrid& grid = (*source)->info().grid;
  TileId least, most;
  int tiles = 0;
  const Status listed = lister->for_each_tile([&](const TileId& id) {
    if (id.squeeze > 0) return true;
    if (tiles == 0 || id.level > least.level) {
      if (tiles > 0 && tile_span_deg(grid, least.level) <= kNarrow_deg) return false;
      least = most = id;
    }
    least = {.level = id.level, .x = std::min(least.x, id.x), .y = std::min(least.y, id.y)};
    most = {.level = id.level, .x = std::max(most.x, id.x), .y = std::max(most.y, id.y)};
    return ++tiles < kMostTiles;
  });
  if (!listed || tiles == 0 || tiles == kMostTiles) return {};
  return if_a_part(bounds_of(grid, least, most));
}

Angle width_of(const GeoRect& bounds) { return Angle::degrees(width_deg(bounds)); }

std::optional<GeoRect> if_a_part(const GeoRect& bounds) {
  if (width_of(bounds).deg() > kMostOfPlanet_deg) return {};
  return bounds;
}

Camera camera_over(const GeoRect& bounds, const Ellipsoid& body, Angle fov_y, double aspect) {
  const double lat_deg = 0.5 * (bounds.south.deg() + bounds.north.deg());
  const double high = bounds.north.rad() - bounds.south.rad();
  const double wide = width_of(bounds).rad() * std::cos(Angle::degrees(lat_deg).rad());
  const double span_m = kRoom * body.a_m() * std::max(high, wide / aspect);
  Camera camera;
  camera.fov_y = fov_y;
  camera.eye = {.lat = Angle::degrees(lat_deg), .lon = bounds.west + 0.5 * width_of(bounds)};
  camera.eye.height_m = std::max(kNearest_m, 0.5 * span_m / std::tan(0.5 * fov_y.rad()));
  return camera;
}

Camera default_camera(const std::optional<GeoRect>& part, const Ellipsoid& body, Viewport picture) {
  Camera whole;
  whole.eye = {.lat = Angle::degrees(20.0), .lon = Angle::degrees(0.0)};
  whole.eye.height_m = whole_globe_height_m(body, whole.fov_y, picture);
  if (!part) return whole;
  Camera over = camera_over(*part, body, whole.fov_y, double(picture.width_px) / picture.height_px);
  over.eye.height_m = std::min(over.eye.height_m, whole.eye.height_m);
  return over;
}

}  // namespace terrella
