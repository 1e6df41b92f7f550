#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "picture_files.h"
#include "reference_pyramid.h"
#include "streaming/cut.h"
#include "streaming/sets/open_tile_set.h"

namespace terrella::test {
namespace {

/// 8-bit levels: one rounding to 8 bits, at the end, and what floats of 24 bits leave over at most seven levels.
constexpr double kOneRounding = 0.5 + 0.001;

struct Cut {
  ScratchFolder folder;
  std::unique_ptr<TileSource> tiles;
  CutSummary summary;
};

std::unique_ptr<Cut> cut_to_png(const Image& picture, CutOptions options, const char* output = "out.gpkg") {
  auto made = std::make_unique<Cut>();
  write_png(made->folder / "in.png", picture);
  options.images = {made->folder / "in.png"};
  options.output = made->folder / output;
  options.format = ImageFormat::png;
  const auto summary = cut(options);
  if (!summary) {
    ADD_FAILURE() << summary.error().message;
    return nullptr;
  }
  made->summary = *summary;
  auto tiles = open_tile_set(options.output);
  if (!tiles) {
    ADD_FAILURE() << tiles.error().message;
    return nullptr;
  }
  made->tiles = *std::move(tiles);
  return made;
}

std::array<int, 4> pixel_at(const Image& image, std::int64_t x, std::int64_t y) {
  const std::uint8_t* p = image.rgba.data() + (y * image.width_px + x) * 4;
  return {p[0], p[1], p[2], p[3]};
}

/// Columns of a level whose pixels lie on the finest level's: all but the last where an odd width was halved twice.
bool aligned(const Image& picture, int steps, std::int64_t x) {
  const std::int64_t side = std::int64_t{1} << steps;
  return (x + 1) * side <= picture.width_px || steps == 0 || picture.width_px % (side / 2) == 0;
}

void expect_right_means(const Image& picture, const Placement& placement, Cut& made) {
  const TileGrid& grid = made.tiles->info().grid;
  for (int level = 0; level <= grid.max_level; ++level) {
    const int steps = grid.max_level - level;
    const std::int64_t side = std::int64_t{1} << steps;
    const Image whole = read_level(*made.tiles, level);
    double worst = 0.0;
    for (std::int64_t y = placement.y0 / side; y * side < placement.y0 + picture.height_px; ++y) {
      for (std::int64_t x = placement.x0 / side; x * side < placement.x0 + picture.width_px; ++x) {
        if (placement.wraps && !aligned(picture, steps, x)) continue;
        const auto got = pixel_at(whole, x, y);
        if (steps == 0) {
          ASSERT_EQ(got, pixel_at(picture, x - placement.x0, y - placement.y0)) << "the source's own pixels";
          continue;
        }
        const auto expected = mean_under(picture, placement, steps, x, y);
        for (std::size_t c = 0; c < 4; ++c) worst = std::max(worst, std::abs(expected[c] - got[c]));
      }
    }
    EXPECT_LE(worst, kOneRounding) << "level " << level;
  }
}

struct PlanetCase {
  int width_px, height_px, tile_px;
  friend void PrintTo(const PlanetCase& one, std::ostream* out) {
    *out << one.width_px << "x" << one.height_px << " in " << one.tile_px;
  }
};

class Planet : public testing::TestWithParam<PlanetCase> {};

TEST_P(Planet, EachPixelIsTheMeanByAreaOfWhatIsUnderIt) {
  const auto& [width_px, height_px, tile_px] = GetParam();
  const Image picture = noise(width_px, height_px);
  const auto made = cut_to_png(picture, {.tile_px = tile_px});
  ASSERT_TRUE(made);
  const TileGrid& grid = made->summary.grid;
  EXPECT_GE(grid.root_span_deg, 180.0 - 1e-9);
  EXPECT_TRUE(grid.max_level == 0 || grid.root_span_deg < 360.0);
  EXPECT_LE(columns(grid, 0), 2);
  EXPECT_EQ(rows(grid, 0), 1);
  expect_right_means(picture, {.pixel_deg = 360.0 / width_px}, *made);
}

// Widths that halve evenly; odd ones at the second, first and every level; less than a tile; one pixel.
INSTANTIATE_TEST_SUITE_P(Sizes, Planet,
                         testing::Values(PlanetCase{128, 64, 16}, PlanetCase{540, 270, 16}, PlanetCase{270, 135, 32},
                                         PlanetCase{135, 68, 16}, PlanetCase{675, 338, 32}, PlanetCase{255, 128, 16},
                                         PlanetCase{100, 50, 256}, PlanetCase{1, 1, 16}, PlanetCase{2, 1, 16},
                                         PlanetCase{34, 17, 16}, PlanetCase{129, 65, 16}));

TEST(PyramidTest, EqualAreaRowsWeighTheSame) {
  const Image picture = noise(96, 48);
  const auto made = cut_to_png(picture, {.tile_px = 16, .projection = Projection::equal_area});
  ASSERT_TRUE(made);
  EXPECT_EQ(made->tiles->info().grid.projection, Projection::equal_area);
  expect_right_means(picture, {.pixel_deg = 360.0 / 96, .equal_area = true}, *made);
}

TEST(PyramidTest, ColoursAreWeighedByAlpha) {
  const Image picture = noise(128, 64, true);
  const auto made = cut_to_png(picture, {.tile_px = 16});
  ASSERT_TRUE(made);
  expect_right_means(picture, {.pixel_deg = 360.0 / 128}, *made);
}

TEST(PyramidTest, WhatIsInvisibleDoesNotTintWhatIsNot) {
  const Image picture = painted(64, 32, [](int x, int, int c) {
    if (c == 3) return x % 2 == 0 ? 254 : 0;
    return x % 2 == 0 ? 200 : 13;
  });
  const auto made = cut_to_png(picture, {.tile_px = 16});
  ASSERT_TRUE(made);
  EXPECT_EQ(pixel_at(read_level(*made->tiles, 0), 3, 3), (std::array{200, 200, 200, 127}));
}

struct RegionCase {
  std::int64_t x0, y0;
  int width_px, height_px;
  friend void PrintTo(const RegionCase& one, std::ostream* out) {
    *out << one.x0 << ", " << one.y0 << ", " << one.width_px << "x" << one.height_px;
  }
};

class Region : public testing::TestWithParam<RegionCase> {};

TEST_P(Region, EdgesAreMeansOfThePartThatIsThere) {
  constexpr double kPixel_deg = 0.75;
  const auto& [x0, y0, width_px, height_px] = GetParam();
  const auto at = [](std::int64_t i) { return static_cast<double>(i) * kPixel_deg; };
  const GeoRect bounds{.west = Angle::degrees(-180.0 + at(x0)),
                       .south = Angle::degrees(90.0 - at(y0 + height_px)),
                       .east = Angle::degrees(-180.0 + at(x0 + width_px)),
                       .north = Angle::degrees(90.0 - at(y0))};
  const Image picture = noise(width_px, height_px);
  const auto made = cut_to_png(picture, {.tile_px = 16, .bounds = bounds});
  ASSERT_TRUE(made);
  EXPECT_NEAR(made->tiles->info().grid.bounds.west.deg(), bounds.west.deg(), 1e-9);
  EXPECT_NEAR(made->tiles->info().grid.bounds.south.deg(), bounds.south.deg(), 1e-9);
  expect_right_means(picture, {.x0 = x0, .y0 = y0, .pixel_deg = kPixel_deg, .wraps = false}, *made);
}

// In the middle with all edges odd; at the north-west corner; one pixel; all longitudes but one pixel.
INSTANTIATE_TEST_SUITE_P(Places, Region,
                         testing::Values(RegionCase{37, 21, 51, 33}, RegionCase{0, 0, 64, 48}, RegionCase{77, 99, 1, 1},
                                         RegionCase{1, 40, 479, 20}, RegionCase{300, 187, 25, 53}));

TEST(PyramidTest, ZoneOfAllLongitudesWraps) {
  const Image picture = noise(150, 25);
  const GeoRect bounds{.south = Angle::degrees(6.0), .north = Angle::degrees(66.0)};
  const auto made = cut_to_png(picture, {.tile_px = 16, .bounds = bounds});
  ASSERT_TRUE(made);
  expect_right_means(picture, {.x0 = 0, .y0 = 10, .pixel_deg = 2.4}, *made);
}

TEST(PyramidTest, RegionsThatCross180AreTheSameTilesAsTheirTwoHalves) {
  const Image picture = noise(60, 40);
  const auto half = [&](int x0, int width) {
    return painted(width, 40, [&](int x, int y, int c) {
      return picture.rgba[static_cast<std::size_t>((y * 60 + x0 + x) * 4 + c)];
    });
  };
  const auto bounds = [](double west, double east) {
    return GeoRect{.west = Angle::degrees(west),
                   .south = Angle::degrees(-20.0),
                   .east = Angle::degrees(east),
                   .north = Angle::degrees(20.0)};
  };
  const auto whole = cut_to_png(picture, {.tile_px = 16, .bounds = bounds(143.0, -157.0)});
  const auto west = cut_to_png(half(0, 37), {.tile_px = 16, .bounds = bounds(143.0, 180.0)});
  const auto east = cut_to_png(half(37, 23), {.tile_px = 16, .bounds = bounds(-180.0, -157.0)});
  ASSERT_TRUE(whole && west && east);
  EXPECT_EQ(whole->summary.tiles, west->summary.tiles + east->summary.tiles);
  const TileGrid& grid = whole->tiles->info().grid;
  EXPECT_LT(grid.bounds.east.deg(), grid.bounds.west.deg());
  std::int64_t seen = 0;
  for (int level = 0; level <= grid.max_level; ++level) {
    for (std::int64_t y = 0; y < rows(grid, level); ++y) {
      for (std::int64_t x = 0; x < columns(grid, level); ++x) {
        const TileId id{level, x, y};
        if (!exists(grid, id)) continue;
        const bool in_west = exists(west->tiles->info().grid, id);
        EXPECT_EQ(read_tile(*whole->tiles, id).rgba, read_tile(in_west ? *west->tiles : *east->tiles, id).rgba);
        ++seen;
      }
    }
  }
  EXPECT_EQ(seen, whole->summary.tiles);
}

TEST(PyramidTest, TransparentPicturesBecomePngsByThemselves) {
  const ScratchFolder folder;
  for (const bool alpha : {false, true}) {
    write_png(folder / "in.png", noise(64, 32, alpha));
    ASSERT_TRUE(cut({.images = {folder / "in.png"}, .output = folder / "out", .tile_px = 16, .force = true}));
    EXPECT_EQ((*open_tile_set(folder / "out"))->info().format, alpha ? ImageFormat::png : ImageFormat::jpeg);
  }
}

/// The colour of coarse JPEG tiles is as sharp as their light: blue and grey stripes, each a pixel wide on level 0.
TEST(PyramidTest, CoarseJpegTilesKeepTheColourOfEachPixel) {
  constexpr double kQuality90_levels = 6.0;  // colour of half the size is off by 50
  const ScratchFolder folder;
  write_png(folder / "in.png",
            painted(128, 64, [](int x, int, int c) { return c == 2 && x / 4 % 2 == 0 ? 200 : 100; }));
  ASSERT_TRUE(cut({.images = {folder / "in.png"}, .output = folder / "out", .tile_px = 16, .quality = 90}));
  const auto tiles = open_tile_set(folder / "out");
  ASSERT_TRUE(tiles);
  const Image coarsest = read_level(**tiles, 0);
  for (int x = 0; x < coarsest.width_px; ++x)
    EXPECT_NEAR(pixel_at(coarsest, x, 4)[2], x % 2 == 0 ? 200 : 100, kQuality90_levels) << x;
}

/// A smooth picture goes on smoothly over ±180° even if the columns no longer lie on the finest level's.
TEST(PyramidTest, OddWidthsAtEveryLevelLeaveNoSeam) {
  constexpr double kSmooth =
      2.0;  // 8-bit levels; neighbours at level 0 differ by up to 39; columns not mixed are off by 5
  const Image picture = painted(129, 65, [](int x, int, int c) {
    const double phase = 2.0 * std::numbers::pi * ((x + 0.5) / 129.0 + c / 3.0);
    return c == 3 ? 255 : static_cast<int>(std::lround(127.5 + 100.0 * std::sin(phase)));
  });
  const auto made = cut_to_png(picture, {.tile_px = 16});
  ASSERT_TRUE(made);
  const int steps = made->summary.grid.max_level;
  ASSERT_EQ(steps, 3);  // widths 129, 65, 33, 17
  const Image coarse = read_level(*made->tiles, 0);
  const std::int64_t side = std::int64_t{1} << steps;
  for (std::int64_t x = 0; x < coarse.width_px; ++x) {
    const double middle = (static_cast<double>(x) + 0.5) * static_cast<double>(side);
    const double expected = 127.5 + 100.0 * std::sin(2.0 * std::numbers::pi * middle / 129.0);
    EXPECT_NEAR(pixel_at(coarse, x, 0)[0], expected, kSmooth) << "column " << x;
  }
}

TEST(PyramidTest, TilesReachOverThePlanetByGoingRoundItAndByRepeatingTheLastRow) {
  const Image picture = noise(40, 20);
  const auto made = cut_to_png(picture, {.tile_px = 16});
  ASSERT_TRUE(made);
  const int finest = made->summary.grid.max_level;
  const Image whole = read_level(*made->tiles, finest);
  ASSERT_EQ(whole.width_px, 48);
  ASSERT_EQ(whole.height_px, 32);
  for (std::int64_t y = 0; y < 32; ++y) {
    for (std::int64_t x = 0; x < 48; ++x) {
      EXPECT_EQ(pixel_at(whole, x, y), pixel_at(picture, x % 40, std::min<std::int64_t>(y, 19)));
    }
  }
}

TEST(PyramidTest, RegionsRepeatTheirEdges) {
  const Image picture = noise(20, 10);
  const GeoRect bounds{.west = Angle::degrees(-170.0),
                       .south = Angle::degrees(70.0),
                       .east = Angle::degrees(-150.0),
                       .north = Angle::degrees(80.0)};
  const auto made = cut_to_png(picture, {.tile_px = 16, .bounds = bounds});
  ASSERT_TRUE(made);
  const Image whole = read_level(*made->tiles, made->summary.grid.max_level);
  for (std::int64_t y = 0; y < 32; ++y) {
    for (std::int64_t x = 0; x < 32; ++x) {
      const auto column = std::clamp<std::int64_t>(x - 10, 0, 19);
      const auto row = std::clamp<std::int64_t>(y - 10, 0, 9);
      EXPECT_EQ(pixel_at(whole, x, y), pixel_at(picture, column, row)) << x << " " << y;
    }
  }
}

TEST(PyramidTest, OddPlanetWithHalfARowTooFewRepeatsItsLast) {
  const Image picture = noise(33, 16);
  const auto made = cut_to_png(picture, {.tile_px = 16});
  ASSERT_TRUE(made);
  const Image whole = read_level(*made->tiles, made->summary.grid.max_level);
  ASSERT_EQ(whole.height_px, 32);
  for (std::int64_t x = 0; x < 33; ++x) EXPECT_EQ(pixel_at(whole, x, 16), pixel_at(picture, x, 15));
}

TEST(PyramidTest, FolderAndGeoPackageHoldTheSameTiles) {
  const Image picture = noise(270, 135);
  const auto packed = cut_to_png(picture, {.tile_px = 32, .jobs = 3});
  const auto folder = cut_to_png(picture, {.tile_px = 32, .jobs = 1}, "tiles");
  ASSERT_TRUE(packed && folder);
  EXPECT_EQ(packed->tiles->info().grid, folder->tiles->info().grid);
  EXPECT_EQ(packed->summary.tiles, folder->summary.tiles);
  EXPECT_EQ(packed->summary.bytes, folder->summary.bytes);
  std::int64_t found = 0;
  for (int level = 0; level <= packed->summary.grid.max_level; ++level) {
    EXPECT_EQ(read_level(*packed->tiles, level).rgba, read_level(*folder->tiles, level).rgba);
    found += columns(packed->summary.grid, level) * rows(packed->summary.grid, level);
  }
  EXPECT_EQ(packed->summary.tiles, found);
}

TEST(PyramidTest, DescriptionIsKept) {
  const auto made = cut_to_png(
      noise(64, 32),
      {.tile_px = 16, .latitude = LatitudeKind::centric, .name = "Noise", .attribution = "nobody", .body = "mars"});
  ASSERT_TRUE(made);
  const TileSetInfo& info = made->tiles->info();
  EXPECT_EQ(info.name, "Noise");
  EXPECT_EQ(info.attribution, "nobody");
  EXPECT_EQ(info.body, "mars");
  EXPECT_EQ(info.grid.latitude, LatitudeKind::centric);
  EXPECT_EQ(info.format, ImageFormat::png);
}

}  // namespace
}  // namespace terrella::test
