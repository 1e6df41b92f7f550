#include "streaming/warp/projected_tiles.h"

#include <utility>

#include "geo/body.h"
#include "streaming/raster/tile_raster.h"
#include "streaming/warp/make_warp_source.h"

namespace terrella {

Result<std::unique_ptr<TileSource>> geodetic_of_projected(std::unique_ptr<TileSource> stored,
                                                          const std::string& where) {
  TileSetInfo info = stored->info();
  const int first_level = info.grid.min_level;
  const Result<Body> body = parse_body(info.body.empty() ? "earth" : info.body);
  if (!body) return Error{where + ": " + body.error().message};
  auto raster = raster_of_tiles(std::move(stored));
  const WarpOptions options{.figure = {.ellipsoid = body->ellipsoid}, .body = info.body, .tile_px = info.grid.tile_px};
  const auto grid = warp_grid(raster->info(), options, where);
  if (!grid) return grid.error();
  auto planner = TilePlanner::open(raster->info(), options.figure, *grid, Overviews::made);
  if (!planner) return Error{where + ": " + planner.error().message};
  info.made_of = info.grid;
  info.grid = *grid;
  if (info.elevation) {
    info.elevation = ElevationInfo{.scale = info.elevation->scale, .offset = info.elevation->offset, .floats = true};
  }
  return make_warp_source(std::move(raster), *std::move(planner), std::move(info),
                          {.noun = "stored tile", .first_level = first_level}, options.decoded_bytes);
}

}  // namespace terrella
