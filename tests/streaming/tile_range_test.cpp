#include "tiles/tile_range.h"

#include <gtest/gtest.h>

#include <set>

namespace terrella {
namespace {

GeoRect rect(double west, double south, double east, double north) {
  return {Angle::degrees(west), Angle::degrees(south), Angle::degrees(east), Angle::degrees(north)};
}

TEST(TileRange, IsEveryTileThatExistsOnce) {
  const GeoRect rects[] = {rect(-180, -90, 180, 90), rect(10, 20, 11, 21),          rect(170, -10, -170, 10),
                           rect(10, -90, 5, 90),     rect(-180, 80, -179, 90),      rect(45, 0, 90, 45),
                           rect(1, -1, -1, 1),       rect(179.99, -90, 180, -89.99)};
  for (const GeoRect& bounds : rects) {
    for (const double root : {180.0, 288.0, 360.0, 273.0666, 7.5}) {
      const TileGrid grid{.root_span_deg = root, .max_level = 4, .bounds = bounds};
      for (int level = 0; level <= (root > 100.0 ? 4 : 0); ++level) {
        std::set<TileId> expected;
        for (std::int64_t y = 0; y < rows(grid, level); ++y) {
          for (std::int64_t x = 0; x < columns(grid, level); ++x) {
            if (exists(grid, {level, x, y})) expected.insert({level, x, y});
          }
        }
        std::set<TileId> found;
        for_each_place(grid, level, [&](const TileId& id) {
          EXPECT_TRUE(found.insert(id).second);
          return true;
        });
        EXPECT_EQ(found, expected) << root << " level " << level << " west " << bounds.west.deg();
        EXPECT_EQ(count_places(grid, level), static_cast<std::int64_t>(expected.size()))
            << root << " level " << level << " west " << bounds.west.deg();
      }
    }
  }
}

TEST(TileRange, CountsAFineLevelWithoutWalkingIt) {
  const TileGrid grid{.max_level = 24};
  EXPECT_EQ(count_places(grid, 24), (1LL << 25) * (1LL << 24));
}

TEST(TileRange, StopsWhenTold) {
  int calls = 0;
  for_each_place({.max_level = 10}, 10, [&](const TileId&) { return ++calls < 3; });
  EXPECT_EQ(calls, 3);
}

}  // namespace
}  // namespace terrella
