#include "apps/preload/preload_plan.h"

#include <set>
#include <string>
#include <utility>

#include "apps/flight/flight_file.h"
#include "apps/preload/flight_tiles.h"
#include "geo/body.h"
#include "streaming/warp/web_mercator.h"

namespace terrella {
namespace {

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
  const std::string name = command.source.redacted();
  if (command.flight.empty()) return plan_area(command.area, info, name);
  const auto body = info.body.empty() ? Result<Body>(earth()) : parse_body(info.body);
  if (!body) return body.error();
  const auto levels = levels_of(command.area, info.grid, name);
  if (!levels) return levels.error();
  return plan_of_flight(command, info, *body, *levels);
}

}  // namespace

Result<std::shared_ptr<const TilePlan>> make_preload_plan(const PreloadCommand& command, const TileSetInfo& info) {
  auto whole = whole_plan(command, info);
  if (!whole || !command.shard) return whole;
  return std::shared_ptr<const TilePlan>(shard_of(*std::move(whole), *command.shard));
}

}  // namespace terrella
