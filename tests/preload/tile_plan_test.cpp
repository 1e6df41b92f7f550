#include "streaming/preload/tile_plan.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>

#include "geo/body.h"
#include "tests/preload/plan_support.h"
#include "tiles/tile_range.h"

namespace terrella {
namespace {

using test::box;
using test::set_of;
using test::tiles_of;

TileGrid grid_of(double root_span_deg, int max_level) {
  TileGrid grid;
  grid.root_span_deg = root_span_deg;
  grid.max_level = max_level;
  return grid;
}

std::unique_ptr<TilePlan> plan_boxes(const TileGrid& grid, const std::vector<GeoRect>& boxes, int first, int last) {
  Region region;
  for (const GeoRect& one : boxes) region.add_box(one);
  return plan_region(grid, earth().ellipsoid, std::move(region), first, last);
}

/// Tiles of the levels that share more than a border with a box, one by one.
std::set<TileId> by_looking_at_each(const TileGrid& grid, const GeoRect& wanted, int first, int last) {
  constexpr double kBorder_deg = 1.0e-9;  // 0.1 mm: under the grid's own slivers at these levels
  std::set<TileId> found;
  for (int level = first; level <= last; ++level) {
    for_each_place(grid, level, [&](const TileId& id) {
      const TileBounds t = tile_bounds(grid, id);
      const double south = latitude_of_row(grid, earth().ellipsoid, t.south_deg).deg();
      const double north = latitude_of_row(grid, earth().ellipsoid, t.north_deg).deg();
      const auto over = [&](double west, double east) {
        return std::min(t.east_deg, 180.0) > west + kBorder_deg && t.west_deg < east - kBorder_deg;
      };
      const bool rows = north > wanted.south.deg() + kBorder_deg && south < wanted.north.deg() - kBorder_deg;
      const bool columns = wanted.west <= wanted.east
                               ? over(wanted.west.deg(), wanted.east.deg())
                               : over(wanted.west.deg(), 180.0) || over(-180.0, wanted.east.deg());
      if (rows && columns) found.insert(id);
      return true;
    });
  }
  return found;
}

TEST(TilePlan, BoxesAsByLookingAtEachTile) {
  const std::vector<GeoRect> boxes = {
      box(5, 43, 17, 49),       box(170, -20, -165, 10), box(-180, -90, 180, 90),    box(-180, 80, 180, 90),
      box(0, -90, 90, -60),     box(0, 0, 90, 45),       box(179.9, 0, -179.9, 0.1), box(-0.01, -0.01, 0.01, 0.01),
      box(-180, -5, -179.5, 5), box(100, 89.9, 101, 90)};
  for (const double span : {180.0, 288.0, 360.0, 273.0666666}) {
    for (const GeoRect& wanted : boxes) {
      const TileGrid grid = grid_of(span, 6);
      const auto plan = plan_boxes(grid, {wanted}, 1, 6);
      const std::vector<TileId> tiles = tiles_of(*plan);
      const std::set<TileId> expected = by_looking_at_each(grid, wanted, 1, 6);
      EXPECT_EQ(std::set<TileId>(tiles.begin(), tiles.end()), expected) << span << ", from " << wanted.west.deg();
      EXPECT_EQ(tiles.size(), expected.size()) << "a tile comes twice";
      EXPECT_EQ(plan->total(), static_cast<std::int64_t>(expected.size()));
    }
  }
}

TEST(TilePlan, GridsThatCountOtherLatitudes) {
  TileGrid grid = grid_of(180.0, 7);
  grid.projection = Projection::equal_area;
  const auto equal_area = plan_boxes(grid, {box(5, 43, 17, 49)}, 0, 7);
  EXPECT_EQ(set_of(*equal_area), by_looking_at_each(grid, box(5, 43, 17, 49), 0, 7));
  grid.projection = Projection::equirectangular;
  grid.latitude = LatitudeKind::centric;
  const auto centric = plan_boxes(grid, {box(5, 43, 17, 49)}, 0, 7);
  EXPECT_EQ(set_of(*centric), by_looking_at_each(grid, box(5, 43, 17, 49), 0, 7));
}

TEST(TilePlan, OverlappingBoxesCountOnce) {
  const auto plan = plan_boxes(grid_of(180.0, 7), {box(0, 0, 20, 20), box(10, 10, 30, 30), box(0, 0, 20, 20)}, 0, 7);
  std::set<TileId> expected = by_looking_at_each(grid_of(180.0, 7), box(0, 0, 20, 20), 0, 7);
  expected.merge(by_looking_at_each(grid_of(180.0, 7), box(10, 10, 30, 30), 0, 7));
  EXPECT_EQ(set_of(*plan), expected);
  EXPECT_EQ(plan->total(), static_cast<std::int64_t>(expected.size()));
}

TEST(TilePlan, StaysWithinTheSetsOwnBoundsAndLevels) {
  TileGrid grid = grid_of(180.0, 6);
  grid.min_level = 2;
  grid.bounds = box(170, -30, -170, 30);
  const auto plan = plan_region(grid, earth().ellipsoid, Region(), 0, 24);
  ASSERT_EQ(plan->counts().front().level, 2);
  ASSERT_EQ(plan->counts().back().level, 6);
  for (const LevelCount& count : plan->counts()) EXPECT_EQ(count.tiles, count_places(grid, count.level));
  for (const TileId& id : tiles_of(*plan)) EXPECT_TRUE(exists(grid, id));
}

TEST(TilePlan, CoarseLevelsFirstAndTheSameEveryTime) {
  const auto plan = plan_boxes(grid_of(180.0, 8), {box(5, 43, 17, 49)}, 0, 8);
  const std::vector<TileId> tiles = tiles_of(*plan);
  EXPECT_TRUE(std::ranges::is_sorted(tiles, {}, &TileId::level));
  EXPECT_EQ(tiles, tiles_of(*plan));
}

std::size_t peak_bytes() {
  rusage use{};
  getrusage(RUSAGE_SELF, &use);
  return static_cast<std::size_t>(use.ru_maxrss) * 1024;
}

TEST(TilePlan, ABillionTilesCountedAndWalkedInLittleMemory) {
  constexpr std::size_t kMost_bytes = 50UL << 20;  // memory that the plan may add to the process
  const std::size_t before = peak_bytes();
  Region region;
  region.add_box(box(-170.003, -75.001, 169.007, 77.777));
  const auto plan = plan_region(grid_of(180.0, 15), earth().ellipsoid, std::move(region), 0, 15);
  EXPECT_GT(plan->total(), 1'000'000'000);
  std::int64_t walked = 0;
  const auto feed = plan->walk();
  while (const auto run = feed->next()) walked += run->count();
  EXPECT_EQ(walked, plan->total());
  EXPECT_LT(peak_bytes() - before, kMost_bytes);
}

TEST(Shard, DisjointCompleteAndEven) {
  const std::shared_ptr<TilePlan> plan = plan_boxes(grid_of(288.0, 9), {box(-20, 30, 40, 71)}, 0, 9);
  const std::set<TileId> whole = set_of(*plan);
  for (const std::int64_t count : {1, 2, 7, 64}) {
    std::set<TileId> together;
    std::int64_t sum = 0;
    for (std::int64_t index = 1; index <= count; ++index) {
      const auto part = shard_of(plan, {index, count});
      const std::vector<TileId> tiles = tiles_of(*part);
      EXPECT_EQ(part->total(), static_cast<std::int64_t>(tiles.size()));
      const std::int64_t levels = 10;
      EXPECT_NEAR(static_cast<double>(part->total()), static_cast<double>(plan->total()) / static_cast<double>(count),
                  static_cast<double>(levels));
      together.insert(tiles.begin(), tiles.end());
      sum += part->total();
    }
    EXPECT_EQ(together, whole);
    EXPECT_EQ(sum, static_cast<std::int64_t>(whole.size())) << "shards overlap";
  }
}

TEST(ListPlan, EachTileOnceInRuns) {
  const auto plan = plan_list({{3, 1, 2}, {0, 0, 0}, {3, 1, 1}, {3, 1, 2}, {3, 2, 0}});
  EXPECT_EQ(tiles_of(*plan), (std::vector<TileId>{{0, 0, 0}, {3, 1, 1}, {3, 1, 2}, {3, 2, 0}}));
  EXPECT_EQ(plan->total(), 4);
  const auto feed = plan->walk();
  (void)feed->next();
  EXPECT_EQ(feed->next(), (TileRun{3, 1, 1, 2}));
}

}  // namespace
}  // namespace terrella
