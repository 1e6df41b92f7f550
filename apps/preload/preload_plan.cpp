#include "apps/preload/preload_plan.h"

#include <fmt/format.h>

#include <functional>
#include <set>
#include <utility>

#include "apps/flight/flight_file.h"
#include "apps/preload/flight_tiles.h"
#include "geo/body.h"
#include "streaming/preload/geojson_region.h"
#include "streaming/preload/projected_places.h"
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
Status check_edges(const Region& region, const std::function<double(int)>& span_deg_of, const LevelRange& levels,
                   int min_level) {
  constexpr double kMostSteps = 1.0e9;
  int finest = levels.last;
  const double steps = region.edge_steps(span_deg_of(finest));
  if (steps <= kMostSteps) return Done{};
  while (finest > min_level && region.edge_steps(span_deg_of(finest)) > kMostSteps) --finest;
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

/// Returns the source tiles of the drawn tiles.
Result<std::vector<TileId>> tiles_flown_over(const std::vector<FlightPath>& path, const Body& body, Viewport size,
                                             const TileSetInfo& info) {
  const auto grid = drawn_grid_of(info);
  if (!grid) return grid.error();
  auto drawn = tiles_along(path, {.body = body, .grid = *grid, .size = size});
  if (*grid == info.grid) return drawn;
  const auto stored = stored_tiles_of(info, drawn);
  if (!stored) return stored.error();
  return std::vector<TileId>(stored->begin(), stored->end());
}

Result<std::shared_ptr<const TilePlan>> plan_of_flight(const PreloadCommand& command, const TileSetInfo& info,
                                                       const Body& body, const LevelRange& levels) {
  const auto flight = read_flight(command.flight);
  if (!flight) return flight.error();
  auto tiles = tiles_flown_over(flight->paths, body, command.size, info);
  if (!tiles) return tiles.error();
  std::erase_if(*tiles, [&](const TileId& id) { return id.level < levels.first || id.level > levels.last; });
  return std::shared_ptr<const TilePlan>(plan_list(*std::move(tiles)));
}

Result<std::shared_ptr<const TilePlan>> whole_plan(const PreloadCommand& command, const TileSetInfo& info) {
  const auto body = info.body.empty() ? Result<Body>(earth()) : parse_body(info.body);
  if (!body) return body.error();
  const auto levels = levels_of(command, info.grid);
  if (!levels) return levels.error();
  if (!command.flight.empty()) return plan_of_flight(command, info, *body, *levels);
  auto region = region_of(command);
  if (!region) return region.error();
  std::shared_ptr<const ProjectedPlaces> projected;
  if (info.square) {
    auto places = ProjectedPlaces::open(info);
    if (!places) return Error{fmt::format("{}: {}", command.source.redacted(), places.error().message)};
    projected = *std::move(places);
  }
  const auto span_deg = [&](int level) {
    return projected ? projected->span_deg(level) : tile_span_deg(info.grid, level);
  };
  if (const Status few = check_edges(*region, span_deg, *levels, info.grid.min_level); !few) return few.error();
  return std::shared_ptr<const TilePlan>(
      plan_region(info.grid, body->ellipsoid, *std::move(region), levels->first, levels->last, std::move(projected)));
}

}  // namespace

Result<std::shared_ptr<const TilePlan>> make_preload_plan(const PreloadCommand& command, const TileSetInfo& info) {
  auto whole = whole_plan(command, info);
  if (!whole || !command.shard) return whole;
  return std::shared_ptr<const TilePlan>(shard_of(*std::move(whole), *command.shard));
}

}  // namespace terrella
