// Planning a frame changes nothing and depends on nothing but its arguments.
#include "surface/frame_plan.h"

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <thread>
#include <tuple>

#include "patch_test_support.h"
#include "relief_test_support.h"

namespace terrella::test {
namespace {

#ifdef __SANITIZE_THREAD__
constexpr int kPlannedViews = 5000;  // of each thread
#else
constexpr int kPlannedViews = 150;
#endif

/// What a plan decides, by values: patches, cells and the tiles and meshes that it wants.
std::vector<double> told(const FramePlan& plan) {
  std::vector<double> all = {double(plan.meshes.size()), double(plan.put_off)};
  const auto tell = [&](const PatchNode& node) {
    all.insert(all.end(), {double(node.id.face), double(node.id.level), double(node.id.x), double(node.id.y)});
  };
  for (const LayerPlan& layer : plan.layers) {
    all.push_back(layer.detail);
    for (const SelectedPatch& p : layer.patches) {
      tell(*p.node);
      all.insert(all.end(), {double(p.tile_level), double(p.squeeze), double(p.coarse_sides), double(p.in_band),
                             double(p.cut_by_view), p.pixel_m, p.footprint_texels});
    }
    all.insert(all.end(), layer.coverage.cells.begin(), layer.coverage.cells.end());
    for (const WantedTile& tile : layer.coverage.wanted) {
      all.insert(all.end(), {double(tile.id.level), double(tile.id.x), double(tile.id.y), tile.priority});
    }
  }
  for (const PatchNode* node : plan.meshes) tell(*node);
  return all;
}

/// All that a node holds, the bytes that its pointers lead to as well.
void tell(const PatchNode& node, std::string& bytes) {
  bytes.append(reinterpret_cast<const char*>(&node), sizeof(node));
  const auto append = [&](const auto& list) {
    bytes.append(reinterpret_cast<const char*>(list.data()), list.size() * sizeof(list[0]));
  };
  append(node.relief.heights_m);
  append(node.relief.slopes);
  if (node.window) append(node.window->cells);
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
    wavy_.relief().set_mesh_budget(kBudget);
    for (PatchTree* tree : {&ground_, &above_}) tree->set_relief(wavy_.relief());
    Draw draw(61);
    for (int k = 0; k < 10; ++k) execute(plan_frame(random_view(draw), snapshot(), {}));
    ground_.refresh_bounds();
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

  void execute(FramePlan plan) {
    PatchTree* trees[] = {&ground_, &above_};
    TileResidency* tiles[] = {&ground_tiles_, &above_tiles_};
    for (std::size_t k = 0; k < 2; ++k) {
      trees[k]->adopt(plan.layers[k].growth);
      note_use(plan.layers[k].coverage.uses, ++frame_, *tiles[k]);
      for (const WantedTile& wanted : plan.layers[k].coverage.wanted) {
        tiles[k]->entry(wanted.id).state = TileState::resident;
        tiles[k]->entry(wanted.id).slot = ++slots_;
      }
    }
    ground_.make_meshes(plan.meshes);
    ground_.refresh_bounds();
  }

  static constexpr int kBudget = 100000;
  static constexpr TileGrid kGrid{.root_span_deg = 180.0, .tile_px = 256, .max_level = 18};
  WavyGround wavy_{8000.0, 2.0, 24};
  PatchTree ground_{wavy_.body(), kGrid, 8}, above_{wavy_.body(), kGrid, 8};
  TileResidency ground_tiles_, above_tiles_;
  std::uint64_t frame_ = 0;
  int slots_ = 0;
};

TEST_F(FramePlans, AreTheSameForTheSameInput) {
  Draw draw(62);
  for (int k = 0; k < 40; ++k) {
    const View view = random_view(draw);
    ASSERT_EQ(told(plan_frame(view, snapshot(), {})), told(plan_frame(view, snapshot(), {}))) << k;
  }
}

TEST_F(FramePlans, LeaveTheBytesOfTheSnapshotAsTheyAre) {
  const std::string ground = bytes_of(ground_, ground_tiles_), above = bytes_of(above_, above_tiles_);
  const std::uint64_t meshes = wavy_.relief().meshes_made();
  Draw draw(63);
  for (int k = 0; k < 40; ++k) static_cast<void>(plan_frame(random_view(draw), snapshot(), {}));
  EXPECT_TRUE(bytes_of(ground_, ground_tiles_) == ground);
  EXPECT_TRUE(bytes_of(above_, above_tiles_) == above);
  EXPECT_EQ(wavy_.relief().meshes_made(), meshes);
}

TEST_F(FramePlans, OfRandomViewsAreTheSameFromTwoThreadsAtOnce) {
  std::vector<std::size_t> hashes[2];
  const auto plan_all = [&](std::vector<std::size_t>& out) {
    Draw draw(64);
    for (int k = 0; k < kPlannedViews; ++k) {
      const std::vector<double> all = told(plan_frame(random_view(draw), snapshot(), {}));
      out.push_back(
          std::hash<std::string_view>{}({reinterpret_cast<const char*>(all.data()), all.size() * sizeof(double)}));
    }
  };
  std::thread other([&] { plan_all(hashes[1]); });
  plan_all(hashes[0]);
  other.join();
  EXPECT_EQ(hashes[0], hashes[1]);
}

// Detail gives way inside the plan, and only as far as it must.
TEST_F(FramePlans, OfMoreTilesThanThereIsRoomForTakeLessDetail) {
  const View view = make_view(camera_at(46, 7, 1.0e5), wavy_.body(), {1920, 1080});
  FrameSnapshot small = snapshot(), large = snapshot();
  large.layers[0].room = 100000;
  EXPECT_EQ(plan_frame(view, large, {}).layers[0].detail, 1.0);
  const FramePlan plan = plan_frame(view, small, {});
  EXPECT_LT(plan.layers[0].detail, 1.0);
  EXPECT_LE(plan.layers[0].coverage.tiles, small.layers[0].room);
}

}  // namespace
}  // namespace terrella::test
