#include "surface/plan/tile_coverage.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <unordered_set>

#include "patch_test_support.h"
#include "surface/patch_mesh.h"
#include "tiles/tile_range.h"

namespace terrella::test {
namespace {

constexpr float kTile_px = 256.0F;
using TileSet = std::unordered_set<TileId, TileIdHash>;

/// Root spans of WorldCRS84Quad, GIBS, a picture of 21600 px and a single root tile; both projections and latitudes.
std::vector<TileGrid> grids() {
  std::vector<TileGrid> all;
  for (const double span : {180.0, 288.0, 256.0 * 64.0 / 60.0, 360.0}) {
    all.push_back({.root_span_deg = span, .max_level = kMaxTileLevel});
  }
  all.push_back({.max_level = kMaxTileLevel, .projection = Projection::equal_area});
  all.push_back({.max_level = kMaxTileLevel, .latitude = LatitudeKind::centric});
  all.push_back({.root_span_deg = 288.0,
                 .max_level = kMaxTileLevel,
                 .projection = Projection::equal_area,
                 .latitude = LatitudeKind::centric});
  for (const double span : {180.0, 256.0 * 64.0 / 60.0}) {
    all.push_back({.root_span_deg = span, .max_level = kMaxTileLevel, .reduced = true});
  }
  return all;
}

/// Covers, and notes nothing.
void cover(PatchTree& tree, const View& view, const std::vector<SelectedPatch>& patches, const TileResidency& residency,
           TileCoverage& coverage) {
  TreeGrowth growth(tree);
  cover_with_tiles({.tree = tree, .growth = growth, .view = view, .patches = patches, .residency = residency},
                   coverage);
  tree.adopt(growth);
}

/// A selected patch by hand: whole, in view, with a window at a level where it has not too many cells.
SelectedPatch selected(PatchTree& tree, const PatchId& id, int tile_level) {
  PatchNode& node = node_of(tree, id);
  return {.node = &node, .tile_level = tile_level, .squeeze = tree.window_squeeze(node, tile_level)};
}

TileWindow window_of(const PatchTree& tree, const PatchNode& node, int level) {
  return tree.make_window(node, level, tree.window_squeeze(node, level));
}

/// The finest level at which a patch's window has no more than `cells` a side.
int level_for(const TileGrid& grid, const PatchNode& node, int cells) {
  const double span = std::max(node.east_deg - node.west_deg, node.north_row_deg - node.south_row_deg);
  int level = grid.max_level;
  while (level > 0 && span > cells * tile_span_deg(grid, level)) --level;
  return level;
}

TEST(TileWindows, HoldEveryVertexOfTheirPatch) {
  Draw draw(41);
  // A border on a tile's border may lie a millionth of a tile beyond the window.
  constexpr double kSliver_tiles = 1.1e-6;
  for (const TileGrid& grid : grids()) {
    PatchTree tree(Ellipsoid(6378137.0, 0.05), grid, kSegments);
    for (int k = 0; k < 200; ++k) {
      const PatchId id =
          k % 5 == 0 ? patch_beside(90, draw.between(-180, 180), 1 + k % 20) : random_patch(draw, 1 + k % 22);
      PatchNode& node = node_of(tree, id);
      const TileWindow win = window_of(tree, node, level_for(grid, node, 1 + k % 20));
      ASSERT_GE(win.x0, 0);
      ASSERT_GE(win.y0, 0);
      ASSERT_LE(win.x0 + win.w, squeezed_columns(grid, win.level, win.squeeze));
      ASSERT_LE(win.y0 + win.h, rows(grid, win.level));
      for (int v = 0; v < 60; ++v) {
        const EcefDir n =
            patch_point(id, draw.whole(0, kSegments), draw.whole(0, kSegments), kSegments, tree.mapping());
        if (n.xyz.x == 0.0 && n.xyz.y == 0.0) continue;
        const double turn = Ellipsoid::lat_lon(n).lon.deg() - node.lon_center_deg;
        const double lon = node.lon_center_deg + turn - 360.0 * std::round(turn / 360.0);
        const TileXY at = tile_xy(grid, win.level, row_latitude_deg(grid, tree.ellipsoid(), n), lon);
        const double wide = std::ldexp(1.0, win.squeeze);
        EXPECT_GE(at.x, double(win.x0) * wide - kSliver_tiles);
        EXPECT_LE(at.x, double(win.x0 + win.w) * wide + kSliver_tiles);
        EXPECT_GE(at.y, double(win.y0) - kSliver_tiles);
        EXPECT_LE(at.y, double(win.y0 + win.h) + kSliver_tiles);
      }
    }
  }
}

/// Makes a random part of the ancestors of a window's tiles resident, the coarsest always; a slot for each.
std::map<int, TileId> fill(Draw& draw, const TileGrid& grid, const TileWindow& win, TileResidency& residency) {
  std::map<int, TileId> tiles;
  const auto put = [&](const TileId& full) {
    const TileId id = reduced_tile(grid, full);
    TileResidency::Entry& entry = residency.entry(id);
    if (entry.state == TileState::resident || !exists(grid, id)) return;
    entry.state = TileState::resident;
    entry.slot = 1 + static_cast<int>(tiles.size());
    tiles[entry.slot] = id;
  };
  for (const TileId& id : root_tiles(grid)) put({id.level, id.x << id.squeeze, id.y});
  for (int y = 0; y < win.h; ++y) {
    for (int x = 0; x < win.w; ++x) {
      TileId id{win.level, (win.x0 + x) << win.squeeze, win.y0 + y};
      for (; id.level > 0; id = parent(id)) {
        if (draw.whole(0, 2) == 0) put(id);
      }
    }
  }
  return tiles;
}

/// Place of the point `offset_deg` from the patch's centre by the window's cells, in the floats of a GPU.
struct Lookup {
  int slot;
  glm::vec2 texel;  // texel in that slot's tile
};
Lookup look_up(const TileCoverage& coverage, const PatchDraw& draw, glm::vec2 offset_deg) {
  const glm::vec4 c = draw.center_and_scale;
  const glm::vec2 p = glm::vec2(c) + offset_deg * glm::vec2(c.z, -c.w);
  const unsigned w = draw.window.y & 0xFFFFU, h = draw.window.y >> 16U;
  const auto x = std::min(static_cast<unsigned>(std::max(p.x, 0.0F)), w - 1);
  const auto y = std::min(static_cast<unsigned>(std::max(p.y, 0.0F)), h - 1);
  const WindowCell cell = coverage.cells[draw.window.x + y * w + x];
  const unsigned rows_up = cell >> 16U & 0xFFU, columns_up = cell >> 24U;
  const glm::vec2 part((draw.window.z + x) & ((1U << columns_up) - 1U), (draw.window.w + y) & ((1U << rows_up) - 1U));
  const glm::vec2 in_tile = (p - glm::vec2(x, y) + part) * glm::vec2(std::ldexp(1.0F, -static_cast<int>(columns_up)),
                                                                     std::ldexp(1.0F, -static_cast<int>(rows_up)));
  return {static_cast<int>(cell & 0xFFFFU), in_tile * kTile_px};
}

void expect_right_tile(const PatchTree& tree, const PatchNode& node, const TileCoverage& coverage,
                       const std::map<int, TileId>& tiles, glm::vec2 offset_deg) {
  const TileGrid& grid = tree.grid();
  const Lookup found = look_up(coverage, coverage.draws[0], offset_deg);
  ASSERT_TRUE(tiles.contains(found.slot));
  const TileId tile = tiles.at(found.slot);
  const TileXY truth =
      tile_xy(grid, tile.level, node.row_center_deg + double(offset_deg.y), node.lon_center_deg + double(offset_deg.x));
  // A thousandth of a texel is far below what a bilinear filter of 8 bits of fraction shows.
  constexpr double kTexel = 1e-3;
  const double column = std::ldexp(truth.x, -tile.squeeze);
  EXPECT_NEAR(double(found.texel.x), (column - double(tile.x)) * double(kTile_px), kTexel) << "level " << tile.level;
  EXPECT_NEAR(double(found.texel.y), (truth.y - double(tile.y)) * double(kTile_px), kTexel) << "level " << tile.level;
}

TEST(TileCoverage, EveryPointFindsItsTileOrTheNearestResidentAncestor) {
  Draw draw(42);
  for (const TileGrid& grid : grids()) {
    PatchTree tree(Ellipsoid(6378137.0, 0.05), grid, kSegments);
    const View view = make_view(camera_at(0, 0, 1e7), tree.ellipsoid(), {512, 512});
    for (int k = 0; k < 250; ++k) {
      const PatchId id = k % 5 == 0 ? patch_beside(k % 2 == 0 ? 90 : -90, draw.between(-180, 180), 1 + k % 20)
                                    : random_patch(draw, 1 + k % 24);
      PatchNode& node = node_of(tree, id);
      const int level = level_for(grid, node, 1 + k % 8);
      TileResidency residency;
      const auto tiles = fill(draw, grid, window_of(tree, node, level), residency);
      TileCoverage coverage;
      cover(tree, view, {selected(tree, id, level)}, residency, coverage);
      EXPECT_EQ(coverage.uncovered, 0);
      const auto vertices = patch_vertices(tree, node);
      for (int v = 0; v < 40; ++v) {
        const auto& a = vertices[draw.whole<std::size_t>(0, vertices.size() - 1)];
        const auto& b = vertices[draw.whole<std::size_t>(0, vertices.size() - 1)];
        expect_right_tile(tree, node, coverage, tiles, glm::mix(a.offset_deg, b.offset_deg, float(draw.between(0, 1))));
        if (HasFatalFailure()) return;
      }
    }
  }
}

TEST(TileCoverage, TheNearestResidentAncestorStandsIn) {
  const TileGrid grid{.max_level = 10};
  PatchTree tree(earth().ellipsoid, grid, kSegments);
  const View view = make_view(camera_at(20, 30, 1e4), tree.ellipsoid(), {512, 512});
  const PatchId id = patch_beside(20, 30, 6);
  TileResidency residency;
  std::map<int, int> level_of_slot = {{0, -1}};
  const TileWindow win = tree.make_window(node_of(tree, id), 8, 0);
  TileCoverage coverage;
  cover(tree, view, {selected(tree, id, 8)}, residency, coverage);
  EXPECT_EQ(coverage.uncovered, 1) << "nothing is resident";
  // Levels become resident one by one; each time all cells move on to the new one.
  for (int level = 0, slot = 1; level <= 8; ++level) {
    for (int y = 0; y < win.h; ++y) {
      for (int x = 0; x < win.w; ++x) {
        TileResidency::Entry& entry = residency.entry(ancestor({8, win.x0 + x, win.y0 + y}, 8 - level));
        if (entry.state == TileState::resident) continue;
        entry.state = TileState::resident;
        entry.slot = slot;
        level_of_slot[slot++] = level;
      }
    }
    cover(tree, view, {selected(tree, id, 8)}, residency, coverage);
    EXPECT_EQ(coverage.uncovered, 0);
    for (const WindowCell& cell : coverage.cells) EXPECT_EQ(level_of_slot.at(static_cast<int>(cell & 0xFFFFU)), level);
    EXPECT_EQ(coverage.wanted.empty(), level == 8);
    EXPECT_EQ(coverage.pending == 0, level == 8);
  }
}

TileGrid europe(int min_level) {
  TileGrid grid{.min_level = min_level, .max_level = 12};
  grid.bounds = {Angle::degrees(-10), Angle::degrees(35), Angle::degrees(40), Angle::degrees(70)};
  return grid;
}

void expect_each_once_and_in_the_grid(const TileGrid& grid, const TileCoverage& coverage) {
  TileSet seen;
  for (const WantedTile& wanted : coverage.wanted) {
    EXPECT_TRUE(seen.insert(wanted.id).second) << "wanted twice";
    EXPECT_TRUE(exists(grid, wanted.id)) << "level " << wanted.id.level << ' ' << wanted.id.x << ' ' << wanted.id.y;
    EXPECT_TRUE(std::isfinite(wanted.priority));
  }
}

/// Serves what is wanted, each tile as resident or as missing, until nothing is wanted.
void serve(const TileCoverage& coverage, TileResidency& residency, int one_in_missing, Draw& draw, int& slot) {
  for (const WantedTile& wanted : coverage.wanted) {
    TileResidency::Entry& entry = residency.entry(wanted.id);
    const bool missing = one_in_missing > 0 && draw.whole(1, one_in_missing) == 1;
    entry.state = missing ? TileState::missing : TileState::resident;
    if (!missing) entry.slot = slot++;
  }
}

TEST(TileCoverage, WantsEachTileOnceNoneOutsideTheGridAndComesToAnEnd) {
  Draw draw(43);
  std::vector<TileGrid> all = grids();
  all.push_back(europe(0));
  all.push_back(europe(3));
  for (TileGrid grid : all) {
    grid.max_level = std::min(grid.max_level, 14);
    PatchTree tree(earth().ellipsoid, grid, kSegments);
    for (int k = 0; k < 12; ++k) {
      const View view = make_view(random_camera(draw, 100.0, 1.0e8), earth().ellipsoid, {400, 300});
      std::vector<SelectedPatch> patches;
      select_patches(tree, view, {}, patches);
      TileResidency residency;
      int slot = 1;
      for (const TileId& id : root_tiles(grid)) {
        residency.entry(id).state = TileState::resident;
        residency.entry(id).slot = slot++;
      }
      TileCoverage coverage;
      std::uint64_t frame = 0;
      do {
        cover(tree, view, patches, residency, coverage);
        ++frame;
        expect_each_once_and_in_the_grid(grid, coverage);
        const bool whole_planet = grid.bounds.north > Angle::degrees(80);
        EXPECT_TRUE(!whole_planet || coverage.uncovered == 0);
        EXPECT_GE(coverage.tiles, coverage.pending + coverage.missing);
        serve(coverage, residency, k % 3 == 0 ? 3 : 0, draw, slot);
        ASSERT_LT(frame, 40U) << "something is wanted for ever";
      } while (!coverage.wanted.empty());
      EXPECT_EQ(coverage.pending, 0);
      EXPECT_EQ(coverage.draws.size(), patches.size());
    }
  }
}

TEST(TileResidency, WhatNoFrameHasHadToDoWithForLongIsForgotten) {
  constexpr std::uint64_t kFrames = 5000;
  TileResidency residency;
  residency.entry({0, 0, 0}).state = TileState::missing;
  residency.entry({9, 0, 1}).state = TileState::resident;
  for (std::uint64_t frame = 1; frame <= kFrames; ++frame) {
    for (std::int64_t x = 0; x < 10; ++x) {
      TileResidency::Entry& entry = residency.entry({9, static_cast<std::int64_t>(10 * frame) + x, 0});
      entry.last_seen = frame;
      if (x < 5) entry.state = TileState::missing;
    }
    residency.end_frame(frame, 0);
  }
  EXPECT_LT(residency.entries().size(), 2 * 4096U);
  EXPECT_NE(residency.find({9, 10 * kFrames, 0}), nullptr);
  EXPECT_NE(residency.find({0, 0, 0}), nullptr) << "of the coarsest level";
  EXPECT_NE(residency.find({9, 0, 1}), nullptr) << "is in a slot";
}

/// The largest texel, in degrees of latitude and of longitude, that still shows all that the picture resolves at a
/// pixel: a picture's frequencies reach half a cycle a pixel in every direction; what they reach along north and east
/// is a row's length of the inverse transposed derivative of the ground by the picture.
std::optional<glm::dvec2> resolved_deg(const View& view, glm::dvec2 px) {
  const auto at = [&](double dx, double dy) { return pick(view, earth().ellipsoid, px + glm::dvec2(dx, dy)); };
  const auto west = at(-0.5, 0.0), east = at(0.5, 0.0), south = at(0.0, 0.5), north = at(0.0, -0.5);
  if (!west || !east || !south || !north) return std::nullopt;
  const auto step = [](const Geodetic& a, const Geodetic& b) {
    return glm::dvec2(b.lat.deg() - a.lat.deg(), std::remainder(b.lon.deg() - a.lon.deg(), 360.0));
  };
  const glm::dmat2 ground_by_picture(step(*west, *east), step(*north, *south));
  const glm::dmat2 inverse = glm::inverse(ground_by_picture);
  return glm::dvec2(1.0 / glm::length(inverse[0]), 1.0 / glm::length(inverse[1]));
}

TEST(TileCoverage, AsksForEveryTileThatTheViewShows) {
  Draw draw(44);
  int spared = 0;
  const TileGrid grid{.max_level = 14};
  PatchTree tree(earth().ellipsoid, grid, kSegments);
  for (int k = 0; k < 60; ++k) {
    const View view = make_view(random_camera(draw, 100.0, 1.0e8), earth().ellipsoid, {400, 300});
    std::vector<SelectedPatch> patches;
    select_patches(tree, view, {}, patches);
    TileResidency residency;
    TileCoverage coverage;
    cover(tree, view, patches, residency, coverage);
    TileSet wanted;
    for (const WantedTile& w : coverage.wanted) wanted.insert(w.id);
    std::map<PatchId, int> levels;
    for (const SelectedPatch& p : patches) levels[p.node->id] = p.tile_level;
    const PatchSet leaves = ids_of(patches);
    for (int n = 0; n < 50; ++n) {
      const glm::dvec2 px(draw.between(0, 400), draw.between(0, 300));
      const auto hit = pick(view, earth().ellipsoid, px);
      if (!hit) continue;
      const EcefDir normal = Ellipsoid::normal(hit->lat, hit->lon);
      const auto leaf = leaf_over(leaves, patch_at(normal, kMaxPatchLevel));
      ASSERT_TRUE(leaf);
      const int level = levels.at(*leaf);
      const TileXY at = tile_xy(grid, level, hit->lat.deg(), hit->lon.deg());
      TileId id{level, static_cast<std::int64_t>(at.x), static_cast<std::int64_t>(at.y)};
      while (!wanted.contains(id) && id.level > 0) id = parent(id);
      ASSERT_TRUE(wanted.contains(id)) << hit->lat.deg() << ", " << hit->lon.deg() << " level " << level;
      if (id.level == level) continue;
      const auto resolved = resolved_deg(view, px);
      if (!resolved) continue;
      // 1.5 at a pole; times 2, as the middle of a cell speaks for its near side too.
      constexpr double kMostTexels = 3.0;
      const double texel_deg = tile_span_deg(grid, id.level) / grid.tile_px;
      EXPECT_LE(texel_deg / std::min(resolved->x, resolved->y), kMostTexels)
          << hit->lat.deg() << ", " << hit->lon.deg() << " level " << id.level << " of " << level << " eye h "
          << earth().ellipsoid.to_geodetic(view.eye).height_m;
      spared += 1;
    }
  }
  EXPECT_GT(spared, 10) << "no cell ever took a coarser tile";
}

/// Tiles that a picture of 1024×1024 straight down asks for.
int tiles_under(PatchTree& tree, double lat, double lon, double height_m, int polar_columns = 32) {
  const View view = make_view(camera_at(lat, lon, height_m), tree.ellipsoid(), {1024, 1024});
  PatchSelectionOptions options;
  options.max_polar_columns = polar_columns;
  std::vector<SelectedPatch> patches;
  select_patches(tree, view, options, patches);
  TileResidency residency;
  TileCoverage coverage;
  cover(tree, view, patches, residency, coverage);
  return coverage.tiles;
}

// CesiumJS asks for 110 tiles of this pyramid in this view, and for 54 and 50 in the others.
TEST(TileCoverage, AsksForFewTilesOfAFullGridOverAPole) {
  PatchTree tree(earth().ellipsoid, {.max_level = 4}, 24);
  EXPECT_LE(tiles_under(tree, 89.9, 0.0, 6.0e6) + 2, 0.8 * 110);
  EXPECT_LE(tiles_under(tree, 30.0, 20.0, 6.0e6) + 2, 0.8 * 54);
  EXPECT_LE(tiles_under(tree, 0.0, 180.0, 6.0e6) + 2, 0.8 * 50);
}

// At every depth, four heights an octave of which the lowest has a pixel to each texel. A set ends two levels deeper.
TEST(ReducedGrid, LookingDownOnAPoleAsksForLittleMoreThanAtTheEquator) {
  constexpr double kMostOverEquator = 1.5;
  const Ellipsoid& earth_ellipsoid = earth().ellipsoid;
  constexpr int kDefaultSegments = 24;
  PatchTree reduced(earth_ellipsoid, {.max_level = 22, .reduced = true}, kDefaultSegments);
  PatchTree full(earth_ellipsoid, {.max_level = 22}, kDefaultSegments);
  for (int level = 3; level <= 20; ++level) {
    const double texel_m = earth_ellipsoid.a_m() * std::numbers::pi / 256.0 * std::ldexp(1.0, -level);
    double at_equator = 0.0, at_pole = 0.0, in_full_grid = 0.0;
    for (const double octave : {1.0, 1.25, 1.5, 1.75}) {
      const double height_m = octave * texel_m * 1024.0 / (2.0 * std::tan(20.0 * std::numbers::pi / 180.0));
      // Over the equator it depends on how tiles lie in the picture: the mean of many places.
      constexpr int kPlaces = 40;
      for (int k = 0; k < kPlaces; ++k)
        at_equator += tiles_under(reduced, 0.0, -179.0 + 8.9 * k, height_m) / double(kPlaces);
      for (const double pole : {90.0, -90.0}) {
        at_pole += tiles_under(reduced, pole, 20.0, height_m) / 2.0;
        in_full_grid += tiles_under(full, pole, 20.0, height_m) / 2.0;
      }
    }
    EXPECT_LE(at_pole, kMostOverEquator * at_equator) << "level " << level;
    if (level > 4) {
      EXPECT_GT(in_full_grid, kMostOverEquator * at_equator) << "level " << level << ": nothing was spared";
    }
  }
}

TEST(RootTiles, AreTheWholeCoarsestLevelWithinTheBounds) {
  EXPECT_EQ(root_tiles({.max_level = 5}).size(), 2U);
  EXPECT_EQ(root_tiles({.root_span_deg = 288.0, .max_level = 5}).size(), 2U);
  EXPECT_EQ(root_tiles({.root_span_deg = 360.0, .max_level = 5}).size(), 1U);
  EXPECT_EQ(root_tiles({.min_level = 2, .max_level = 5}).size(), 32U);
  for (const TileId& id : root_tiles(europe(3))) EXPECT_TRUE(exists(europe(3), id));
  EXPECT_EQ(root_tiles(europe(0)).size(), 2U);
}

TEST(RootTiles, OfAReducedGridAreThoseThatExist) {
  TileGrid grid = europe(4);
  grid.reduced = true;
  std::set<TileId> expected;
  for (std::int64_t y = 0; y < rows(grid, grid.min_level); ++y) {
    for (std::int64_t x = 0; x < columns(grid, grid.min_level); ++x) {
      if (exists(grid, {grid.min_level, x, y})) expected.insert(reduced_tile(grid, {grid.min_level, x, y}));
    }
  }
  const std::vector<TileId> roots = root_tiles(grid);
  EXPECT_EQ(roots.size(), expected.size());
  EXPECT_EQ(std::set<TileId>(roots.begin(), roots.end()), expected);
}

// A planet has 10^12 tiles of level 20: they cannot be looked through.
TEST(RootTiles, OfACityAreFoundAtADeepLevel) {
  TileGrid city = europe(20);
  city.max_level = 20;
  city.bounds = {Angle::degrees(8.5), Angle::degrees(47.3), Angle::degrees(8.51), Angle::degrees(47.31)};
  const auto across = static_cast<std::size_t>(std::ceil(0.01 / tile_span_deg(city, 20)));
  EXPECT_GE(root_tiles(city).size(), across * across);
  EXPECT_LE(root_tiles(city).size(), (across + 1) * (across + 1));
  EXPECT_TRUE(check_root_tiles(city));
  city.bounds = {};
  EXPECT_FALSE(check_root_tiles(city));
}

}  // namespace
}  // namespace terrella::test
