#include "streaming/warp/web_mercator.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "geo/body.h"
#include "streaming/raster/tile_raster.h"
#include "streaming/warp/warp_source.h"
#include "tiles/grid_ranges.h"

namespace terrella {
namespace {

/// A finer level is not used for a shortfall below this fraction of a level.
constexpr double kFinerSlack = 0.02;

/// Rows of the tiles count the same latitude as the stored tiles'.
WarpFigure figure_of(const TileGrid& grid) {
  return {.ellipsoid = earth().ellipsoid, .latitude = grid.latitude, .crs_latitude = grid.latitude};
}

/// Warps the stored tiles of another time. `stored` must outlive the function.
SourceAtTime warped_at_time(TileSource& stored, const std::string& where) {
  return [&stored, where](UtcTime time) -> Result<std::unique_ptr<TileSource>> {
    auto other = stored.at_time(time);
    if (!other) return other.error();
    return as_geodetic(*std::move(other), where);
  };
}

/// Warps a set in a `projected` grid.
Result<std::unique_ptr<TileSource>> geodetic_of_projected(std::unique_ptr<TileSource> stored,
                                                          const std::string& where) {
  TileSetInfo info = stored->info();
  const int first_level = info.grid.min_level;
  const Result<Body> body = parse_body(info.body.empty() ? "earth" : info.body);
  if (!body) return Error{where + ": " + body.error().message};
  SourceAtTime at_time = warped_at_time(*stored, where);
  auto raster = raster_of_tiles(std::move(stored));
  const WarpOptions options{.figure = {.ellipsoid = body->ellipsoid}, .body = info.body, .tile_px = info.grid.tile_px};
  const auto grid = warp_grid(raster->info(), options, where);
  if (!grid) return grid.error();
  auto planner = TilePlanner::open(raster->info(), options.figure, *grid, Overviews::made);
  if (!planner) return Error{where + ": " + planner.error().message};
  info.made_of = info.grid;
  info.grid = *grid;
  if (info.numbers) info.numbers = decoded(*info.numbers);
  return make_warp_source(std::move(raster), *std::move(planner), std::move(info),
                          {.noun = "stored tile", .first_level = first_level}, options.decoded_bytes,
                          std::move(at_time));
}

}  // namespace

TileGrid geodetic_grid_of(const TileGrid& mercator) {
  assert(mercator.projection == Projection::web_mercator);
  TileGrid grid = mercator;
  grid.projection = Projection::equirectangular;
  const auto within = [](Angle side) {
    return Angle::degrees(std::clamp(side.deg(), -kMercatorEndDeg, kMercatorEndDeg));
  };
  grid.bounds.south = within(mercator.bounds.south);
  grid.bounds.north = within(mercator.bounds.north);
  const double farthest = std::max(std::abs(grid.bounds.south.deg()), std::abs(grid.bounds.north.deg()));
  const double cosine = std::cos(Angle::degrees(farthest).rad());
  const int further = static_cast<int>(std::floor(-std::log2(cosine) + kFinerSlack));
  grid.max_level = std::min(mercator.max_level + std::max(further, 0), kMaxTileLevel);
  return grid;
}

Result<std::set<TileId>> stored_tiles_of(const TileGrid& mercator, std::span<const TileId> geodetic) {
  TileSetInfo set;
  set.grid = mercator;
  const RasterInfo raster = raster_info_of(set);
  auto planner = TilePlanner::open(raster, figure_of(mercator), geodetic_grid_of(mercator), Overviews::stored);
  if (!planner) return planner.error();
  std::set<TileId> stored;
  for (const TileId& id : geodetic) {
    const auto plan = (*planner)->plan(id);
    if (!plan) return Error{plan.error().why};
    for (const WarpPiece& piece : plan->pieces) {
      const TileId tile{.level = piece.id.level + mercator.min_level, .x = piece.id.x, .y = piece.id.y};
      if (exists(mercator, tile)) stored.insert(tile);
    }
  }
  return stored;
}

Result<std::unique_ptr<TileSource>> as_geodetic(std::unique_ptr<TileSource> stored, const std::string& where) {
  TileSetInfo info = stored->info();
  if (info.grid.projection == Projection::projected) return geodetic_of_projected(std::move(stored), where);
  if (info.grid.projection != Projection::web_mercator) return stored;
  const TileGrid mercator = info.grid;
  info.made_of = mercator;
  info.grid = geodetic_grid_of(mercator);
  if (Status good = check_grid(info.grid, where + ": between the ends of Web Mercator"); !good) return good.error();
  if (info.numbers) info.numbers = decoded(*info.numbers);
  SourceAtTime at_time = warped_at_time(*stored, where);
  auto raster = raster_of_tiles(std::move(stored));
  auto planner = TilePlanner::open(raster->info(), figure_of(mercator), info.grid, Overviews::stored);
  if (!planner) return Error{where + ": " + planner.error().message};
  return make_warp_source(std::move(raster), *std::move(planner), std::move(info),
                          {.noun = "Web Mercator tile", .first_level = mercator.min_level}, kWarpDecodedBytes,
                          std::move(at_time));
}

}  // namespace terrella
