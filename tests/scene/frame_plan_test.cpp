// plan_frame() changes nothing and depends on nothing but its arguments.
#include "surface/plan/frame_plan.h"

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <string_view>
#include <thread>
#include <tuple>
#include <utility>

#include "patch_test_support.h"
#include "relief_test_support.h"
#include "surface/plan/plan_text.h"

namespace terrella::test {
namespace {

/// All that a node holds, the bytes that its pointers lead to as well.
void tell(const PatchNode& node, std::string& bytes) {
  bytes.append(reinterpret_cast<const char*>(&node), sizeof(node));
  const auto append = [&](const auto& list) {
    bytes.append(reinterpret_cast<const char*>(list.data()), list.size() * sizeof(list[0]));
  };
  append(node.relief.heights_m);
  if (node.window) {
    append(node.window->cells);
    for (const CellExtent& cell : node.window->cells) {
      if (cell.lattice) append(cell.lattice->points_m);
    }
  }
  for (const PatchNode* child : node.children) {
    if (child != nullptr) tell(*child, bytes);
  }
}

std::string bytes_of(const PatchTree& tree, const TileResidency& tiles) {
  std::string bytes;
  for (int f = 0; f < kCubeFaces; ++f) tell(tree.root(static_cast<CubeFace>(f)), bytes);
  std::map<std::tuple<int, std::int64_t, std::int64_t, int>, TileResidency::Entry> sorted;
  for (const auto& [id, e] : tiles.entries()) sorted[{id.level, id.x, id.y, id.squeeze}] = e;
  for (const auto& [id, e] : sorted) {
    for (const std::uint64_t number : {static_cast<std::uint64_t>(e.state), static_cast<std::uint64_t>(e.slot),
                                       e.last_drawn, e.last_needed, e.last_seen}) {
      bytes.append(reinterpret_cast<const char*>(&number), sizeof(number));
    }
  }
  return bytes;
}

/// Ground with heights, two layers over it, and what some frames have left in the trees and the residencies.
class FramePlans : public ::testing::Test {
 protected:
  FramePlans() {
    wavy_.add_level(0);
    for (PatchTree* tree : {&ground_, &above_}) wavy_.relief().refresh_bounds(*tree);
    Draw draw(61);
    for (int k = 0; k < 10; ++k) execute(plan(random_view(draw)));
  }

  [[nodiscard]] View random_view(Draw& draw) const {
    return make_view(random_camera(draw, 1.0e3, 5.0e7), wavy_.body(), {64, 48});
  }

  [[nodiscard]] FrameSnapshot snapshot() const {
    FrameSnapshot all;
    all.layers.push_back({.tree = &ground_, .tiles = &ground_tiles_, .room = 40});
    all.layers.push_back({.tree = &above_, .tiles = &above_tiles_});
    return all;
  }

  [[nodiscard]] FramePlan plan(const View& view, FramePlan recycled = {}) const {
    return plan_frame(view, snapshot(), options_, std::move(recycled));
  }

  void execute(FramePlan plan) {
    PatchTree* trees[] = {&ground_, &above_};
    TileResidency* tiles[] = {&ground_tiles_, &above_tiles_};
    for (std::size_t k = 0; k < 2; ++k) {
      trees[k]->adopt(plan.layers[k].growth);
      plan.layers[k].coverage.uses.note(++frame_, *tiles[k]);
      for (const WantedTile& wanted : plan.layers[k].coverage.wanted) {
        tiles[k]->entry(wanted.id).state = TileState::resident;
        tiles[k]->entry(wanted.id).slot = ++slots_;
      }
    }
    wavy_.relief().make_meshes(ground_, plan.meshes);
  }

  static constexpr TileGrid kGrid{.root_span_deg = 180.0, .tile_px = 256, .max_level = 18};
  WavyGround wavy_{8000.0, 2.0, 24};
  PatchTree ground_{wavy_.body(), kGrid, 4}, above_{wavy_.body(), kGrid, 4};
  TileResidency ground_tiles_, above_tiles_;
  PatchSelectionOptions options_{.relief = &wavy_.relief()};
  std::uint64_t frame_ = 0;
  int slots_ = 0;
};

TEST_F(FramePlans, AreTheSameForTheSameInput) {
  Draw draw(62);
  FramePlan recycled;
  std::size_t patches = 0;
  for (int k = 0; k < 40; ++k) {
    const View view = random_view(draw);
    const FramePlan first = plan(view), again = plan(view);
    ASSERT_TRUE(first == again) << k;
    recycled = plan(view, std::move(recycled));
    ASSERT_TRUE(first == recycled) << k;
    ASSERT_EQ(to_text(first), to_text(recycled));
    patches += first.layers[0].patches.size();
  }
  EXPECT_GT(patches, 400U);
}

TEST_F(FramePlans, LeaveTheBytesOfTheSnapshotAsTheyAre) {
  const std::string ground = bytes_of(ground_, ground_tiles_), above = bytes_of(above_, above_tiles_);
  Draw draw(63);
  for (int k = 0; k < 40; ++k) static_cast<void>(plan(random_view(draw)));
  EXPECT_TRUE(bytes_of(ground_, ground_tiles_) == ground);
  EXPECT_TRUE(bytes_of(above_, above_tiles_) == above);
}

// The thread sanitizer sees a thread that writes what the other one reads.
TEST_F(FramePlans, OfRandomViewsAreTheSameFromTwoThreadsAtOnce) {
  constexpr int kViews = 10000;  // small ones from far: planned in a minute under the sanitizer
  std::vector<std::size_t> hashes[2];
  const auto plan_all = [&](std::vector<std::size_t>& out) {
    Draw draw(64);
    FramePlan last;
    for (int k = 0; k < kViews; ++k) {
      const Camera camera = random_camera(draw, 1.0e6, 5.0e7);
      last = plan(make_view(camera, wavy_.body(), {16, 12}), std::move(last));
      out.push_back(std::hash<std::string>{}(to_text(last)));
    }
  };
  std::thread other([&] { plan_all(hashes[1]); });
  plan_all(hashes[0]);
  other.join();
  EXPECT_EQ(hashes[0], hashes[1]);
}

// The plan of the view below, as it was recorded.
constexpr std::string_view kRecordedPlan = R"(frame layers 1 meshes 0 put off 0
layer detail 1 tiles 12 pending 12 missing 0 uncovered 7 shown false uses 62
patch 4/5/17/0 level 7 squeeze 0 coarse 0 cut pixel 997.965 m footprint 3.28345 cells 7070000 7070000 7070000 7070000 7070000 7070000 7070000 7070000 7070000
patch 4/5/17/1 level 6 squeeze 0 coarse 0 cut pixel 1387.97 m footprint 2.23505 cells 6060000 6060000 6060000 6060000
patch 4/5/18/0 level 7 squeeze 0 coarse 0 cut pixel 904.154 m footprint 2.23608 cells 7070000 7070000 7070000 7070000 7070000 7070000 7070000 7070000 7070000
patch 4/5/19/0 level 7 squeeze 0 coarse 0 cut pixel 1049.31 m footprint 3.9743 cells 7070000 7070000 7070000 7070000 7070000 7070000 7070000 7070000 7070000
patch 4/5/18/1 level 7 squeeze 0 coarse 0 cut pixel 1190.79 m footprint 3.73327 cells 7070000 7070000 7070000 7070000 7070000 7070000 7070000 7070000 7070000 7070000 7070000 7070000
patch 4/5/19/1 level 6 squeeze 0 coarse 0 cut pixel 1667.82 m footprint 3.36656 cells 6060000 6060000 6060000 6060000
patch 4/5/17/2 level 5 squeeze 0 coarse 0 cut pixel 3070.65 m footprint 2.57627 cells 5050000 5050000 5050000 5050000
patch 4/5/18/2 level 5 squeeze 0 coarse 0 cut pixel 2927.41 m footprint 2.41781 cells 5050000 5050000 5050000 5050000
patch 4/5/19/2 level 5 squeeze 0 coarse 0 cut pixel 3461.74 m footprint 3.28892 cells 5050000 5050000 5050000 5050000
patch 4/5/20/1 level 5 squeeze 0 coarse 0 cut pixel 2773.92 m footprint 3.41504 cells 5050000 5050000
patch 4/4/11/1 level 3 squeeze 0 coarse 0 cut pixel 13156.8 m footprint 9.86493 cells 3030000 3030000
patch 4/4/8/2 level 3 squeeze 0 coarse 0 cut pixel 12711.4 m footprint 5.51936 cells 3030000
tile 7/132/30/0 priority -6.53529
tile 6/66/14/0 priority -5.65347
tile 6/66/15/0 priority -5.65347
tile 7/133/30/0 priority -6.57574
tile 7/134/30/0 priority -6.57574
tile 7/133/31/0 priority -6.57574
tile 7/134/31/0 priority -6.57574
tile 6/67/15/0 priority -5.61399
tile 6/68/15/0 priority -5.61399
tile 6/67/14/0 priority -5.67627
tile 6/68/14/0 priority -5.69905
tile 5/34/7/0 priority -4.72117
)";

TEST(FramePlan, OfARecordedViewIsTheRecordedOne) {
  const View view = make_view(camera_at(46, 7, 3.0e5, 30, -60), earth().ellipsoid, {320, 240});
  const PatchTree tree(earth().ellipsoid, {.root_span_deg = 180.0, .tile_px = 256, .max_level = 18}, 8);
  const TileResidency tiles;
  const FramePlan plan =
      plan_frame(view, {.layers = {{.tree = &tree, .tiles = &tiles}}, .sun = {}, .patch_shuffle = {}}, {});
  EXPECT_EQ(to_text(plan), kRecordedPlan);
}

// Detail gives way inside the plan, and only as far as it must.
TEST_F(FramePlans, OfMoreTilesThanThereIsRoomForTakeLessDetail) {
  const View view = make_view(camera_at(46, 7, 1.0e5), wavy_.body(), {1920, 1080});
  FrameSnapshot small = snapshot(), large = snapshot();
  large.layers[0].room = 100000;
  EXPECT_EQ(plan_frame(view, large, options_).layers[0].detail, 1.0);
  const FramePlan plan = plan_frame(view, small, options_);
  EXPECT_LT(plan.layers[0].detail, 1.0);
  EXPECT_LE(plan.layers[0].coverage.tiles, small.layers[0].room);
}

// Each round of the search for a coarser view plans the whole frame.
TEST_F(FramePlans, KeepTheirDetailIfThereAreNoCoarserTiles) {
  PatchTree tree(wavy_.body(), {.root_span_deg = 15.0, .tile_px = 256, .max_level = 2}, 4);
  TileResidency tiles;
  const FrameSnapshot snapshot{
      .layers = {{.tree = &tree, .tiles = &tiles, .room = 40}}, .sun = {}, .patch_shuffle = {}};
  const FramePlan plan = plan_frame(make_view(camera_at(0, 0, 3.0e7), wavy_.body(), {64, 64}), snapshot, {});
  EXPECT_GT(plan.layers[0].coverage.tiles, 40);
  EXPECT_EQ(plan.layers[0].detail, 1.0);
}

}  // namespace
}  // namespace terrella::test
