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

/// The options by which a set in a `projected` grid is warped. The error is the reason alone.
Result<WarpOptions> options_of_projected(const TileSetInfo& info) {
  const Result<Body> body = parse_body(info.body.empty() ? "earth" : info.body);
  if (!body) return body.error();
  return WarpOptions{.figure = {.ellipsoid = body->ellipsoid}, .body = info.body, .tile_px = info.grid.tile_px};
}

/// Inserts the stored tiles of which a tile is made.
void insert_stored(const TileGrid& stored, const TilePlanner& planner, const WarpPlan& plan, std::set<TileId>& tiles) {
  for (const WarpPiece& piece : plan.pieces) {
    const int level = planner.frame().levels[static_cast<std::size_t>(piece.id.level)].stored;
    const TileId tile{.level = level + stored.min_level, .x = piece.id.x, .y = piece.id.y};
    if (exists(stored, tile)) tiles.insert(tile);
  }
}

/// The stored tiles of which tiles are made.
Result<std::set<TileId>> planned_tiles(const TileGrid& stored, TilePlanner& planner, std::span<const TileId> tiles) {
  std::set<TileId> found;
  for (const TileId& id : tiles) {
    const auto plan = planner.plan(id);
    if (!plan) return Error{plan.error().why};
    insert_stored(stored, planner, *plan, found);
  }
  return found;
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
  const auto options = options_of_projected(info);
  if (!options) return Error{where + ": " + options.error().message};
  SourceAtTime at_time = warped_at_time(*stored, where);
  auto raster = raster_of_tiles(std::move(stored));
  const auto grid = warp_grid(raster->info(), *options, where);
  if (!grid) return grid.error();
  auto planner = TilePlanner::open(raster->info(), options->figure, *grid, Overviews::made);
  if (!planner) return Error{where + ": " + planner.error().message};
  info.made_of = info.grid;
  info.grid = *grid;
  if (info.numbers) info.numbers = decoded(*info.numbers);
  return make_warp_source(std::move(raster), *std::move(planner), std::move(info),
                          {.noun = "stored tile", .first_level = first_level}, options->decoded_bytes,
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
  return planned_tiles(mercator, **planner, geodetic);
}

Result<TileGrid> drawn_grid_of(const TileSetInfo& stored) {
  if (stored.grid.projection == Projection::web_mercator) return geodetic_grid_of(stored.grid);
  if (stored.grid.projection != Projection::projected) return stored.grid;
  const auto options = options_of_projected(stored);
  if (!options) return options.error();
  return warp_grid(raster_info_of(stored), *options, "its grid");
}

Result<std::set<TileId>> stored_tiles_of(const TileSetInfo& stored, std::span<const TileId> drawn) {
  if (stored.grid.projection == Projection::web_mercator) return stored_tiles_of(stored.grid, drawn);
  if (stored.grid.projection != Projection::projected) return std::set<TileId>(drawn.begin(), drawn.end());
  const auto options = options_of_projected(stored);
  if (!options) return options.error();
  const RasterInfo raster = raster_info_of(stored);
  const auto grid = warp_grid(raster, *options, "its grid");
  if (!grid) return grid.error();
  auto planner = TilePlanner::open(raster, options->figure, *grid, Overviews::made);
  if (!planner) return planner.error();
  return planned_tiles(stored.grid, **planner, drawn);
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
