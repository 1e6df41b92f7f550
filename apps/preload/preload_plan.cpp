#include "apps/preload/preload_plan.h"

#include <fmt/format.h>

#include <set>
#include <utility>

#include "apps/flight/flight_file.h"
#include "apps/preload/flight_tiles.h"
#include "geo/body.h"
#include "streaming/preload/geojson_region.h"
#include "streaming/warp/web_mercator.h"

namespace terrella {
namespace {

Result<LevelRange> levels_of(const PreloadCommand& command, const TileGrid& grid) {
  const LevelRange has{grid.min_level, grid.max_level};
  if (!command.levels) return has;
  if (command.levels->first < has.first || command.levels->last > has.last) {
    return Error{fmt::format("--levels {}-{}: {} has levels {} to {}", command.levels->first, command.levels->last,
                             command.source.redacted(), has.first, has.last)};
  }
  return *command.levels;
}

/// Refuses polygons whose plan would take many minutes.
Status check_edges(const Region& region, const TileGrid& grid, const LevelRange& levels) {
  constexpr double kMostSteps = 1.0e9;
  int finest = levels.last;
  const double steps = region.edge_steps(tile_span_deg(grid, finest));
  if (steps <= kMostSteps) return Done{};
  while (finest > 0 && region.edge_steps(tile_span_deg(grid, finest)) > kMostSteps) --finest;
  return Error{
      fmt::format("--polygon: its edges pass {:.1g} tiles of level {}, too many to plan; simplify the polygons, "
                  "remove edges that lie on each other, or end --levels at {}",
                  steps, levels.last, finest)};
}

Result<Region> region_of(const PreloadCommand& command) {
  Region region;
  for (const GeoRect& box : command.boxes) region.add_box(box);
  for (const std::string& path : command.polygons) {
    const auto polygons = read_geojson_region(path);
    if (!polygons) return polygons.error();
    region.add(*polygons);
  }
  return region;
}

/// For Web Mercator, returns the source tiles of the drawn tiles.
Result<std::vector<TileId>> tiles_flown_over(const std::vector<FlightPath>& path, const Body& body, Viewport size,
                                             const TileGrid& grid) {
  if (grid.projection != Projection::web_mercator) return tiles_along(path, {.body = body, .grid = grid, .size = size});
  const auto stored =
      stored_tiles_of(grid, tiles_along(path, {.body = body, .grid = geodetic_grid_of(grid), .size = size}));
  if (!stored) return stored.error();
  return std::vector<TileId>(stored->begin(), stored->end());
}

Result<std::shared_ptr<const TilePlan>> whole_plan(const PreloadCommand& command, const TileSetInfo& info) {
  const auto body = info.body.empty() ? Result<Body>(earth()) : parse_body(info.body);
  if (!body) return body.error();
  const auto levels = levels_of(command, info.grid);
  if (!levels) return levels.error();
  if (info.square && (!command.flight.empty() || !command.boxes.empty() || !command.polygons.empty())) {
    return Error{
        fmt::format("{}: its tiles are in {}, and areas and flights choose tiles in EPSG:4326 or EPSG:3857 alone; "
                    "preload all of it, or --levels of it",
                    command.source.redacted(), info.square->crs.substr(0, 100))};
  }
  if (!command.flight.empty()) {
    auto path = read_flight(command.flight);
    if (!path) return path.error();
    auto tiles = tiles_flown_over(*path, *body, command.size, info.grid);
    if (!tiles) return tiles.error();
    std::erase_if(*tiles, [&](const TileId& id) { return id.level < levels->first || id.level > levels->last; });
    return std::shared_ptr<const TilePlan>(plan_list(*std::move(tiles)));
  }
  auto region = region_of(command);
  if (!region) return region.error();
  if (const Status few = check_edges(*region, info.grid, *levels); !few) return few.error();
  return std::shared_ptr<const TilePlan>(
      plan_region(info.grid, body->ellipsoid, *std::move(region), levels->first, levels->last));
}

}  // namespace

Result<std::shared_ptr<const TilePlan>> make_preload_plan(const PreloadCommand& command, const TileSetInfo& info) {
  auto whole = whole_plan(command, info);
  if (!whole || !command.shard) return whole;
  return std::shared_ptr<const TilePlan>(shard_of(*std::move(whole), *command.shard));
}

}  // namespace terrella
