#include "streaming/sets/crs_levels.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace terrella {

double tiles_over(double length, double span) {
  constexpr double kSliver = 1e-6;  // tiles
  return std::max(1.0, std::ceil(length / span - kSliver));
}

std::int64_t longer_side(const CrsLevel& level) { return std::max(level.columns, level.rows); }

std::int64_t halved_up(std::int64_t tiles, std::size_t times) {
  const std::int64_t one = std::int64_t{1} << times;
  return (tiles + one - 1) / one;
}

void place_own_levels(const std::string& crs, std::vector<CrsLevel> levels, TileSetInfo& info) {
  std::int64_t roots = 1;
  for (std::size_t i = 0; i < levels.size(); ++i) roots = std::max(roots, halved_up(longer_side(levels[i]), i));
  const CrsLevel& finest = levels.back();
  TileGrid& grid = info.grid;
  grid.projection = Projection::projected;
  grid.root_span_deg = 360.0 / static_cast<double>(roots);
  grid.min_level = 0;
  grid.max_level = static_cast<int>(levels.size()) - 1;
  grid.bounds = {.south = Angle::degrees(-180.0), .north = Angle::degrees(180.0)};
  const double side = finest.unit_per_px * grid.tile_px * static_cast<double>(longer_side(finest));
  info.square = CrsSquare{.crs = crs, .west = finest.west, .north = finest.north, .unit_per_deg = side / 360.0};
  info.square->levels = std::move(levels);
}

}  // namespace terrella
