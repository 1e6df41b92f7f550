#include "tiles/tile_range.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace terrella {
namespace {

/// Range of the numbers near [low, high] for which `is_there` holds. `is_there` knows the rule for slivers and decides
/// on the first and the last number. The search begins at most one number outside. A number that exists for another
/// reason (the same bounds a turn away) is therefore not taken for the end of this span.
template <class IsThere>
TileSpan span_over(double low, double high, std::int64_t count, const IsThere& is_there) {
  const auto most = static_cast<double>(count);
  TileSpan span{static_cast<std::int64_t>(std::clamp(std::ceil(low) - 1.0, 0.0, most)),
                static_cast<std::int64_t>(std::clamp(std::floor(high), -1.0, most - 1.0))};
  while (span.first <= span.last && !is_there(span.first)) ++span.first;
  while (span.last >= span.first && !is_there(span.last)) --span.last;
  return span;
}

// A tile exists if its column touches the bounds' longitudes and its row their latitudes. Each range can therefore be
// found with the other bounds open.
TileSpan rows_in_bounds(const TileGrid& grid, int level) {
  TileGrid band = grid;
  band.bounds.west = GeoRect{}.west;
  band.bounds.east = GeoRect{}.east;
  const RowLatitudes range = row_bounds(grid);
  const double north = tile_xy(grid, level, range.north_deg, 0.0).y;
  const double south = tile_xy(grid, level, range.south_deg, 0.0).y;
  return span_over(north, south, rows(grid, level), [&](std::int64_t y) { return exists(band, {level, 0, y}); });
}

/// Ascending spans, each column once. Bounds over ±180° give two spans. A last column that reaches over 180° may belong
/// to the bounds that begin at -180°.
std::vector<TileSpan> columns_in_bounds(const TileGrid& grid, int level) {
  TileGrid wedge = grid;
  const double top_deg = grid.projection == Projection::projected ? 180.0 : 90.0;
  wedge.bounds.south = Angle::degrees(-top_deg);
  wedge.bounds.north = Angle::degrees(top_deg);
  const double west_deg = grid.bounds.west.deg();
  const double east_deg = grid.bounds.east.deg() + (grid.bounds.east < grid.bounds.west ? 360.0 : 0.0);
  std::vector<TileSpan> spans;
  constexpr std::array kTurnsDeg{-360.0, 0.0, 360.0};
  for (const double turn_deg : kTurnsDeg) {
    const double west = tile_xy(grid, level, 0.0, west_deg + turn_deg).x;
    const double east = tile_xy(grid, level, 0.0, east_deg + turn_deg).x;
    TileSpan span = span_over(west, east, columns(grid, level), [&](std::int64_t x) {
      return exists(wedge, {level, x, 0});
    });
    if (!spans.empty()) span.first = std::max(span.first, spans.back().last + 1);
    if (span.first <= span.last) spans.push_back(span);
  }
  return spans;
}

}  // namespace

TilePlaces tile_places(const TileGrid& grid, int level) {
  return {columns_in_bounds(grid, level), rows_in_bounds(grid, level)};
}

void for_each_place(const TileGrid& grid, int level, const std::function<bool(const TileId&)>& call) {
  const TilePlaces places = tile_places(grid, level);
  for (std::int64_t y = places.rows.first; y <= places.rows.last; ++y) {
    for (const TileSpan& span : places.columns) {
      for (std::int64_t x = span.first; x <= span.last; ++x) {
        if (!call({level, x, y})) return;
      }
    }
  }
}

std::int64_t count_places(const TileGrid& grid, int level) {
  const TilePlaces places = tile_places(grid, level);
  std::int64_t columns = 0;
  for (const TileSpan& span : places.columns) columns += span.last - span.first + 1;
  return columns * std::max<std::int64_t>(0, places.rows.last - places.rows.first + 1);
}

std::vector<TileId> root_tiles(const TileGrid& grid) {
  std::vector<TileId> tiles;
  for_each_place(grid, grid.min_level, [&](const TileId& full) {
    const TileId id = reduced_tile(grid, full);
    if (tiles.empty() || tiles.back() != id) tiles.push_back(id);
    return true;
  });
  return tiles;
}

Status check_root_tiles(const TileGrid& grid) {
  const std::int64_t roots = count_places(grid, grid.min_level);
  if (roots <= kMostRootTiles) return Done{};
  return Error{
      fmt::format("its coarsest level, {}, has {} tiles within its bounds, more than the {} that can stay in memory; "
                  "add coarser levels, or narrow the bounds",
                  grid.min_level, roots, kMostRootTiles)};
}

}  // namespace terrella
