#include "surface/plan/patch_selection.h"

#include <gtest/gtest.h>

#include "patch_test_support.h"
#include "relief_test_support.h"
#include "view/stereo.h"

namespace terrella::test {
namespace {

// Most patches of a frame, whatever the camera: more would mean that the subdivision ran away.
constexpr std::size_t kRunaway = 20000;

std::ostream& operator<<(std::ostream& out, const Camera& c) {
  return out << c.eye.lat.deg() << ',' << c.eye.lon.deg() << ',' << c.eye.height_m << ',' << c.heading.deg() << ','
             << c.pitch.deg() << ',' << c.fov_y.deg();
}

void expect_no_overlap(const std::vector<SelectedPatch>& patches) {
  const PatchSet leaves = ids_of(patches);
  EXPECT_EQ(leaves.size(), patches.size()) << "a patch was selected twice";
  for (const PatchId& id : leaves) {
    ASSERT_GE(id.level, 1) << "below level 1 a patch may straddle the antimeridian";
    EXPECT_FALSE(leaf_over(leaves, parent(id))) << "a patch and its ancestor are both drawn";
  }
}

void expect_balanced(const std::vector<SelectedPatch>& patches) {
  const PatchSet leaves = ids_of(patches);
  for (const SelectedPatch& patch : patches) {
    for (int side = 0; side < 4; ++side) {
      const auto other = leaf_over(leaves, neighbour(patch.node->id, static_cast<PatchSide>(side)));
      const bool coarser = other && other->level < patch.node->id.level;
      EXPECT_TRUE(!other || other->level >= patch.node->id.level - 1) << "side " << side;
      EXPECT_EQ((patch.coarse_sides >> side & 1U) != 0, coarser) << "side " << side;
    }
  }
}

/// Rays through the picture's corners, edges and inside: what they hit must be drawn.
void expect_nothing_visible_culled(const View& view, const Ellipsoid& body, const std::vector<SelectedPatch>& patches,
                                   Draw& draw) {
  const PatchSet leaves = ids_of(patches);
  const double w = view.viewport.width_px, h = view.viewport.height_px;
  for (int k = 0; k < 60; ++k) {
    const double x = k % 4 == 0 ? w * draw.whole(0, 1) : draw.between(0.0, w);
    const double y = k % 4 <= 1 ? h * draw.whole(0, 1) : draw.between(0.0, h);
    const EcefDir ray = pixel_ray(view, {x, y});
    const auto distance_m = body.intersect_m(view.eye, ray);
    if (!distance_m) continue;
    const EcefDir normal = body.surface_normal(Ecef{view.eye.xyz_m + *distance_m * ray.xyz});
    EXPECT_TRUE(leaf_over(leaves, patch_at(normal, kMaxPatchLevel))) << "pixel " << x << ", " << y << " has no patch";
  }
}

void check(PatchTree& tree, const Camera& camera, Viewport viewport, Draw& draw) {
  std::ostringstream name;
  name << "camera " << camera << " picture " << viewport.width_px << 'x' << viewport.height_px << " a "
       << tree.ellipsoid().a_m();
  SCOPED_TRACE(name.str());
  const View view = make_view(camera, tree.ellipsoid(), viewport);
  std::vector<SelectedPatch> patches;
  select_patches(tree, view, {}, patches);
  ASSERT_LT(patches.size(), kRunaway);
  expect_no_overlap(patches);
  expect_balanced(patches);
  expect_nothing_visible_culled(view, tree.ellipsoid(), patches, draw);
}

TileGrid deep_grid() { return {.max_level = 18}; }

TEST(PatchSelection, FromUnderTheGroundOnlyWhatTheInnerSphereHidesIsLeftOut) {
  Draw draw(23);
  PatchTree tree(earth().ellipsoid, deep_grid(), kSegments);
  constexpr double kInner_m = 5.378e6;
  std::size_t automatic = 0, all = 0, nearby = 0;
  for (int k = 0; k < 60; ++k) {
    Camera camera = random_camera(draw, 10.0, 9.0e5);
    camera.eye.height_m = -camera.eye.height_m;
    const View view = make_view(camera, earth().ellipsoid, {400, 300});
    std::vector<SelectedPatch> patches;
    const auto count = [&](HorizonCulling culling) {
      PatchSelectionOptions options;
      options.horizon_culling = culling;
      options.inner_sphere_m = kInner_m;
      select_patches(tree, view, options, patches);
      return patches.size();
    };
    all += count(HorizonCulling::off);
    nearby += count(HorizonCulling::on);
    automatic += count(HorizonCulling::automatic);
    const PatchSet leaves = ids_of(patches);
    const Ellipsoid inner(kInner_m, 0.0);
    for (int n = 0; n < 40; ++n) {
      const EcefDir ray = pixel_ray(view, {draw.between(0, 400), draw.between(0, 300)});
      if (inner.intersect_m(view.eye, ray)) continue;
      const auto distance_m = earth().ellipsoid.intersect_m(view.eye, ray);
      ASSERT_TRUE(distance_m);
      const EcefDir normal = earth().ellipsoid.surface_normal(Ecef{view.eye.xyz_m + *distance_m * ray.xyz});
      EXPECT_TRUE(leaf_over(leaves, patch_at(normal, kMaxPatchLevel))) << "a wall that is in sight has no patch";
    }
  }
  EXPECT_LT(automatic, all) << "nothing was left out";
  EXPECT_LE(nearby, automatic);
}

TEST(PatchSelection, OneSelectionHoldsWhatBothEyesSee) {
  Draw draw(19);
  for (const Body& body : selection_bodies()) {
    PatchTree tree(body.ellipsoid, deep_grid(), kSegments);
    const double a = body.ellipsoid.a_m();
    for (int k = 0; k < 40 && !HasFailure(); ++k) {
      const Camera camera = random_camera(draw, 1.6e-7 * a, 16.0 * a);
      const View view = make_view(camera, body.ellipsoid, {800, 600});
      const EyePair eyes = stereo_eyes(view, body.ellipsoid, {.mode = Stereo::anaglyph, .eye_separation_m = {}});
      std::vector<SelectedPatch> patches;
      select_patches(tree, eyes.both, {}, patches);
      expect_balanced(patches);
      expect_nothing_visible_culled(eyes.left, body.ellipsoid, patches, draw);
      expect_nothing_visible_culled(eyes.right, body.ellipsoid, patches, draw);
    }
  }
}

TEST(PatchSelection, TilesWhatIsVisibleForRandomCamerasOnEveryBody) {
  Draw draw(1);
  for (const Body& body : selection_bodies()) {
    PatchTree tree(body.ellipsoid, deep_grid(), kSegments);
    const double a = body.ellipsoid.a_m();
    for (int k = 0; k < 100 && !HasFailure(); ++k)
      check(tree, random_camera(draw, 1.6e-7 * a, 16.0 * a), {1024, 768}, draw);
  }
}

TEST(PatchSelection, SurvivesTheHardCameras) {
  Draw draw(2);
  for (const Body& body : selection_bodies()) {
    PatchTree tree(body.ellipsoid, deep_grid(), kSegments);
    const double a = body.ellipsoid.a_m(), b = body.ellipsoid.b_m();
    std::vector<Camera> cameras = {camera_at(47, 8, 1.0),
                                   camera_at(47, 8, 1.0, 30, 0),
                                   camera_at(47, 8, 1.0, 30, 90),
                                   camera_at(0, 0, 3.844e8),
                                   camera_at(-30, 100, 3.844e8, 0, 0),
                                   camera_at(90, 0, 0.3 * a, 77),
                                   camera_at(-90, 0, 10, 200, -10),
                                   camera_at(90, 123, a, 10, -60),
                                   camera_at(10, 180, 1000, 0, -5),
                                   camera_at(10, -180, 0.1 * a, 0),
                                   camera_at(0, 180, 0.01 * a, 90, -89),
                                   camera_at(45, 45, 0.2 * a, 0, -90, 120),
                                   camera_at(5, 5, 0.1 * a, 0, 90),
                                   camera_at(20, 20, -1.0),
                                   camera_at(20, 20, -0.001 * a, 0, 20),
                                   camera_at(90, 0, -b),
                                   camera_at(0, 0, -a, 40, 10),
                                   camera_at(1, 2, -0.5 * a, 0, 60, 120),
                                   camera_at(47, 8, 0.0, 0, -10),
                                   camera_at(47, 8, 1e12)};
    for (const Camera& camera : cameras) {
      for (const double fov : {1.0, 40.0, 120.0}) {
        Camera c = camera;
        c.fov_y = Angle::degrees(fov);
        check(tree, c, {512, 512}, draw);
      }
      if (HasFailure()) return;
    }
  }
}

TEST(PatchSelection, SurvivesTheSmallestAndTheWidestPicture) {
  Draw draw(3);
  PatchTree tree(earth().ellipsoid, deep_grid(), kSegments);
  for (const Viewport viewport : {Viewport{1, 1}, Viewport{16384, 16}, Viewport{16, 16384}}) {
    for (const double fov : {1.0, 40.0, 120.0}) {
      check(tree, camera_at(47, 8, 2000, 30, -20, fov), viewport, draw);
      check(tree, camera_at(80, 180, 1.0e6, 0, -60, fov), viewport, draw);
      check(tree, camera_at(0, 0, 4.0e8, 0, -90, fov), viewport, draw);
    }
  }
}

TEST(PatchSelection, SelectsNothingForAViewThatIsNotFinite) {
  PatchTree tree(earth().ellipsoid, deep_grid(), kSegments);
  std::vector<SelectedPatch> patches;
  for (const double bad : {kNaN, kInfinity, -kInfinity}) {
    for (int field = 0; field < 6; ++field) {
      View view = make_view(camera_at(10, 20, 1.0e6), earth().ellipsoid, {100, 100});
      double* const fields[] = {&view.eye.xyz_m.x, &view.eye.xyz_m.z, &view.right.y,
                                &view.up.x,        &view.forward.z,   &view.tan_half_fov_y};
      *fields[field] = bad;
      select_patches(tree, view, {}, patches);
      EXPECT_TRUE(patches.empty()) << "field " << field << " = " << bad;
    }
  }
}

void expect_same(const std::vector<SelectedPatch>& first, const std::vector<SelectedPatch>& again) {
  ASSERT_EQ(first.size(), again.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].node->id, again[i].node->id);
    EXPECT_EQ(first[i].coarse_sides, again[i].coarse_sides);
    EXPECT_EQ(first[i].tile_level, again[i].tile_level);
  }
}

TEST(PatchSelection, GivesTheSameListWhateverWasSelectedBefore) {
  Draw draw(4);
  PatchTree used(earth().ellipsoid, deep_grid(), kSegments);
  std::vector<SelectedPatch> first, again;
  for (int k = 0; k < 30; ++k) {
    const View view = make_view(random_camera(draw, 10.0, 1.0e8), earth().ellipsoid, {640, 480});
    PatchTree fresh(earth().ellipsoid, deep_grid(), kSegments);
    select_patches(fresh, view, {}, first);
    select_patches(used, view, {}, again);
    expect_same(first, again);
  }
}

// Two trees that give nodes up: one of the surface, and one of further imagery over it.
TEST(PatchSelection, WhatNoFrameComesToGoesAndNothingElseChanges) {
  constexpr std::size_t kMany = 200;
  Draw draw(14);
  PatchTree used(earth().ellipsoid, deep_grid(), kSegments), above(earth().ellipsoid, deep_grid(), kSegments);
  std::vector<SelectedPatch> first, again, further;
  std::size_t dropped = 0;
  for (int k = 0; k < 60; ++k) {
    // A flight between two places: what is given up comes back.
    Camera camera = random_camera(draw, 10.0, 1.0e8);
    if (k % 3 == 0) camera = camera_at(46, 7, 1.0e4 * (1 + k % 2), 30, -20);
    const View view = make_view(camera, earth().ellipsoid, {320, 240});
    PatchTree fresh(earth().ellipsoid, deep_grid(), kSegments);
    select_patches(fresh, view, {}, first);
    TreeGrowth growth(used), growth_above(above);
    const FurtherImagery over{.tree = &above, .growth = &growth_above, .out = &further};
    again = plan_patches(used, growth, view, {}, std::span(&over, 1)).patches;
    used.adopt(growth);
    above.adopt(growth_above);
    for (PatchTree* tree : {&used, &above}) {
      const std::size_t before = tree->size();
      tree->end_frame(kMany);
      dropped += before - tree->size();
      EXPECT_LE(tree->size(), std::max(kMany, 3 * fresh.size()));
    }
    expect_same(first, again);  // no selected node was given up
    for (const SelectedPatch& patch : further) EXPECT_EQ(patch.node->id, patch.surface->id);
  }
  EXPECT_GT(dropped, 10 * kMany);
}

// A loaded tile of heights without loaded neighbours makes a cliff. An eye among the heights of one or two tiles is
// within the bounds of all patches around.
TEST(PatchSelection, ACliffBetweenHeightsThatCameAndThatDidNotIsNoRunaway) {
  constexpr double kMost_m = 8000.0, kExaggeration = 20.0;
  WavyGround wavy(kMost_m, kExaggeration, 24);
  wavy.add_level(0);
  for (const std::int64_t x : {0, 5, 6, 11}) wavy.add_tile({WavyGround::kLevel, x, 0});
  PatchTree tree(wavy.body(), deep_grid(), 8);
  StereoLook stereo;
  std::vector<SelectedPatch> patches;
  for (const double lat : {90.0, 80.0}) {
    for (const double height_m : {1.0, 2.0e3, 2.0e5}) {
      const View eye = make_view(camera_at(lat, 3.0, height_m, 30, -20), wavy.body(), {64, 32});
      select_patches(tree, stereo_eyes(eye, wavy.ground(), stereo).both, {.relief = &wavy.relief()}, patches);
      EXPECT_LT(patches.size(), kRunaway / 10) << lat << " " << height_m;
    }
  }
}

TEST(Relief, MissingTilesAreForgottenWhereNoViewHasWantedThemForLong) {
  constexpr int kViews = 900, kMost = 2 * 4096 + 1000;
  Draw draw(15);
  Relief relief(earth().ellipsoid, {.tile_px = 32, .max_level = 12}, 1.0);
  PatchTree tree(earth().ellipsoid, deep_grid(), 8);
  std::vector<SelectedPatch> patches;
  int missing = 0;
  for (int k = 0; k < kViews; ++k) {
    const View view = make_view(random_camera(draw, 1.0e3, 1.0e6), earth().ellipsoid, {64, 48});
    select_patches(tree, view, {.relief = &relief, .mesh_budget = 0}, patches);
    for (const WantedTile& tile : relief.want(patches)) {
      relief.tiles().set_missing(tile.id, std::nullopt);
      ++missing;
    }
    for (const WantedTile& tile : relief.want(patches)) ADD_FAILURE() << "wants what is missing: " << tile.id.level;
    EXPECT_LT(relief.missing(), kMost);
    tree.end_frame();
  }
  EXPECT_GT(missing, 3 * kMost / 2);
}

TEST(PatchSelection, SpheresHoldTheirPatches) {
  Draw draw(5);
  for (const Body& body : selection_bodies()) {
    PatchTree tree(body.ellipsoid, deep_grid(), kSegments);
    for (int level = 1; level <= 22; level += 3) {
      const PatchNode& node = node_of(tree, random_patch(draw, level));
      for (int k = 0; k < 200; ++k) {
        const EcefDir n = patch_point(node.id, draw.whole(0, 64), draw.whole(0, 64), 64, tree.mapping());
        const double d = glm::distance(body.ellipsoid.position(n).xyz_m, node.sphere.center_m);
        // Ground between the mesh's vertices bulges by the mesh's error.
        EXPECT_LE(d, node.sphere.radius_m + node.geometric_error_m);
      }
    }
  }
}

}  // namespace
}  // namespace terrella::test
