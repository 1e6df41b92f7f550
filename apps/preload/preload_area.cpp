#include "apps/preload/preload_area.h"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <utility>

#include "apps/open_scene/options/option_checks.h"
#include "base/number.h"
#include "geo/body.h"
#include "streaming/preload/geojson_region.h"
#include "streaming/preload/geojson_route.h"
#include "streaming/preload/projected_places.h"

namespace terrella {
namespace {

Result<LevelRange> parse_levels(const std::string& text) {
  const std::size_t dash = text.find('-');
  const auto first = read_number(text.substr(0, dash));
  const auto last = dash == std::string::npos ? first : read_number(text.substr(dash + 1));
  const auto is_level = [](const std::optional<double>& n) {
    return n && *n >= 0 && *n <= kMaxTileLevel && *n == std::floor(*n);
  };
  if (!is_level(first) || !is_level(last) || *first > *last) {
    return Error{
        fmt::format("{} is no range of levels; write FIRST-LAST, as 0-8, in 0...{}", in_quotes(text), kMaxTileLevel)};
  }
  return LevelRange{static_cast<int>(*first), static_cast<int>(*last)};
}

Result<GeoRect> parse_box(const std::string& text) {
  std::vector<double> sides;
  const auto pieces = split_at_commas(text);
  for (const std::string_view piece : pieces) {
    if (const auto degrees = read_number(piece)) sides.push_back(*degrees);
  }
  if (sides.size() != 4 || pieces.size() != 4) {
    return Error{fmt::format("{} is not W,S,E,N; write four numbers in degrees, as 5,43,17,49", in_quotes(text))};
  }
  const bool on_planet = std::abs(sides[0]) <= 180.0 && std::abs(sides[2]) <= 180.0 && std::abs(sides[1]) <= 90.0 &&
                         std::abs(sides[3]) <= 90.0;
  if (!on_planet || sides[1] >= sides[3] || sides[0] == sides[2]) {
    return Error{fmt::format("{}: WEST and EAST take -180...180 (WEST > EAST crosses 180°), SOUTH < NORTH -90...90",
                             in_quotes(text))};
  }
  return GeoRect{.west = Angle::degrees(sides[0]),
                 .south = Angle::degrees(sides[1]),
                 .east = Angle::degrees(sides[2]),
                 .north = Angle::degrees(sides[3])};
}

/// Refuses shapes whose plan would take many minutes.
Status check_edges(const Region& region, const std::function<double(int)>& span_deg_of, const LevelRange& levels,
                   int min_level) {
  constexpr double kMostSteps = 1.0e9;
  int finest = levels.last;
  const double steps = region.edge_steps(span_deg_of(finest));
  if (steps <= kMostSteps) return Done{};
  while (finest > min_level && region.edge_steps(span_deg_of(finest)) > kMostSteps) --finest;
  return Error{
      fmt::format("--polygon, --route: the edges pass {:.1g} tiles of level {}, too many to plan; simplify the shapes, "
                  "remove edges that lie "
                  "on each other, or end --levels at {}",
                  steps, levels.last, finest)};
}

Result<Region> region_of(const PreloadArea& area, const Ellipsoid& ellipsoid) {
  Region region;
  for (const GeoRect& box : area.boxes) region.add_box(box);
  for (const std::string& path : area.polygons) {
    const auto polygons = read_geojson_region(path);
    if (!polygons) return polygons.error();
    region.add(*polygons);
  }
  for (const std::string& path : area.routes) {
    const auto route = read_geojson_route(path, area.radius_m, ellipsoid);
    if (!route) return route.error();
    region.add(*route);
  }
  return region;
}

}  // namespace

void add_area_options(CLI::App& app, PreloadArea& area) {
  app.add_option_function<std::string>(
         "--levels",
         [&area](const std::string& text) { area.levels = parsed_or_throw("--levels", parse_levels(text)); },
         "Set the tile levels, coarsest to finest (default: all of the set)")
      ->type_name("A-B");
  app.add_option_function<std::vector<std::string>>(
         "--bbox",
         [&area](const std::vector<std::string>& texts) {
           for (const std::string& text : texts) {
             area.boxes.push_back(parsed_or_throw("--bbox", parse_box(text)));
           }
         },
         "Add a box in degrees; WEST > EAST crosses 180°. Repeatable")
      ->type_name("W,S,E,N")
      ->allow_extra_args(false);
  app.add_option("--polygon", area.polygons, "Add GeoJSON polygons; edges are great circles. Repeatable")
      ->type_name("F.geojson")
      ->allow_extra_args(false);
  app.add_option("--route", area.routes, "Add all places within --radius of GeoJSON lines. Repeatable")
      ->type_name("F.geojson")
      ->allow_extra_args(false);
  app.add_option("--radius", area.radius_m, "Set the distance from the lines of --route, metres")
      ->check(number_in(1.0, 1e7));
}

Status check_area(const PreloadArea& area) {
  if (area.routes.empty() == (area.radius_m == 0.0)) return Done{};
  return Error{"--route and --radius go together: the lines of a file, and the metres to both sides of them"};
}

Result<LevelRange> levels_of(const PreloadArea& area, const TileGrid& grid, const std::string& name) {
  const LevelRange has{grid.min_level, grid.max_level};
  if (!area.levels) return has;
  if (area.levels->first < has.first || area.levels->last > has.last) {
    return Error{fmt::format("--levels {}-{}: {} has levels {} to {}", area.levels->first, area.levels->last, name,
                             has.first, has.last)};
  }
  return *area.levels;
}

Result<std::shared_ptr<const TilePlan>> plan_area(const PreloadArea& area, const TileSetInfo& info,
                                                  const std::string& name, TileRule rule) {
  const auto body = info.body.empty() ? Result<Body>(earth()) : parse_body(info.body);
  if (!body) return body.error();
  const auto levels = levels_of(area, info.grid, name);
  if (!levels) return levels.error();
  auto region = region_of(area, body->ellipsoid);
  if (!region) return region.error();
  std::shared_ptr<const ProjectedPlaces> projected;
  if (info.square) {
    auto places = ProjectedPlaces::open(info);
    if (!places) return Error{fmt::format("{}: {}", name, places.error().message)};
    projected = *std::move(places);
  }
  const auto span_deg = [&](int level) {
    return projected ? projected->span_deg(level) : tile_span_deg(info.grid, level);
  };
  if (const Status few = check_edges(*region, span_deg, *levels, info.grid.min_level); !few) return few.error();
  return std::shared_ptr<const TilePlan>(plan_region(info.grid, body->ellipsoid, *std::move(region), levels->first,
                                                     levels->last, std::move(projected), rule));
}

}  // namespace terrella
