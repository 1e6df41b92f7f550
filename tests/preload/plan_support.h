#pragma once

#include <set>
#include <vector>

#include "streaming/preload/tile_plan.h"

namespace terrella::test {

/// Every tile of a walk, in its order.
inline std::vector<TileId> tiles_of(const TilePlan& plan) {
  std::vector<TileId> tiles;
  const auto feed = plan.walk();
  while (const auto run = feed->next()) {
    for (std::int64_t y = run->first_y; y <= run->last_y; ++y) tiles.push_back({run->level, run->x, y});
  }
  return tiles;
}

inline std::set<TileId> set_of(const TilePlan& plan) {
  const std::vector<TileId> tiles = tiles_of(plan);
  return {tiles.begin(), tiles.end()};
}

inline GeoRect box(double west, double south, double east, double north) {
  return {Angle::degrees(west), Angle::degrees(south), Angle::degrees(east), Angle::degrees(north)};
}

}  // namespace terrella::test
