#include <gtest/gtest.h>

#include <cstdio>

#include "streaming/cut/cut_plan.h"

namespace terrella::test {
namespace {

GeoRect degrees(double west, double south, double east, double north) {
  return {.west = Angle::degrees(west),
          .south = Angle::degrees(south),
          .east = Angle::degrees(east),
          .north = Angle::degrees(north)};
}

Result<CutPlan> plan(std::int64_t width, std::int64_t height, std::optional<GeoRect> bounds = {}, int tile_px = 256) {
  CutOptions options;
  options.images = {"picture.jpg"};
  options.bounds = bounds;
  options.tile_px = tile_px;
  return plan_cut({.width_px = width, .height_px = height, .has_alpha = false}, options);
}

struct Row {
  std::int64_t width;
  int finest;
  double root_span_deg;
};

TEST(CutPlanTest, RootSpansOfKnownPictures) {
  constexpr double kSpan_deg = 0.005;  // the table gives two decimals
  for (const Row& row : {Row{21600, 6, 273.07}, Row{4096, 3, 180.0}, Row{8192, 4, 180.0}, Row{11469, 5, 257.14},
                         Row{86400, 8, 273.07}, Row{256, 0, 360.0}, Row{512, 0, 180.0}, Row{514, 1, 358.60}}) {
    const auto made = plan(row.width, row.width / 2);
    ASSERT_TRUE(made) << made.error().message;
    EXPECT_EQ(made->grid.max_level, row.finest) << row.width;
    EXPECT_NEAR(made->grid.root_span_deg, row.root_span_deg, kSpan_deg) << row.width;
    EXPECT_LE(columns(made->grid, 0) * rows(made->grid, 0), 2) << row.width;
  }
}

TEST(CutPlanTest, OddPlanetsMayHaveEitherHeight) {
  EXPECT_TRUE(plan(11469, 5734));
  EXPECT_TRUE(plan(11469, 5735));
  EXPECT_FALSE(plan(11469, 5733));
  EXPECT_FALSE(plan(11469, 5736));
  EXPECT_FALSE(plan(11470, 5734));
}

TEST(CutPlanTest, NotTwoToOneSaysWhatToDo) {
  const auto made = plan(300, 300);
  ASSERT_FALSE(made);
  for (const char* part : {"picture.jpg", "300x300", "2:1", "‹bounds› W,S,E,N"}) {
    EXPECT_NE(made.error().message.find(part), std::string::npos) << made.error().message;
  }
}

TEST(CutPlanTest, BoundsOfTheWholePlanetAreThePlanet) {
  const auto made = plan(11469, 5734, degrees(-180, -90, 180, 90));
  ASSERT_TRUE(made);
  EXPECT_TRUE(made->wraps);
  EXPECT_EQ(made->grid, plan(11469, 5734)->grid);
}

TEST(CutPlanTest, PixelsThatAreNotSquareAreRefused) {
  const auto made = plan(100, 100, degrees(0, 0, 20, 10));
  ASSERT_FALSE(made);
  EXPECT_NE(made.error().message.find("not square"), std::string::npos);
}

TEST(CutPlanTest, ARegionOffTheGridMovesTheOrigin) {
  const auto made = plan(120, 60, degrees(5.03, 43.04, 17.03, 49.04));
  ASSERT_TRUE(made) << made.error().message;
  const TileGrid& grid = made->grid;
  EXPECT_GT(grid.west_deg, -180.0 - made->pixel_deg);
  EXPECT_LT(grid.west_deg, -180.0);
  EXPECT_GT(grid.north_deg, 90.0);
  EXPECT_LT(grid.north_deg, 90.0 + made->pixel_deg);
  EXPECT_NEAR(grid.west_deg + static_cast<double>(made->finest.x0) * made->pixel_deg, 5.03, 1e-9);
  EXPECT_NEAR(grid.north_deg - static_cast<double>(made->finest.y1) * made->pixel_deg, 43.04, 1e-9);
  EXPECT_NEAR(grid.bounds.west.deg(), 5.03, 1e-9);
  EXPECT_NEAR(grid.bounds.north.deg(), 49.04, 1e-9);
}

TEST(CutPlanTest, AnOriginBeside180IsRefusedForPicturesOverIt) {
  for (const GeoRect& bounds : {degrees(170.03, 43.0, -177.97, 49.0), degrees(-179.97, -60.0, 180.03, 60.0)}) {
    const auto made = plan(bounds.east < bounds.west ? 120 : 3600, bounds.east < bounds.west ? 60 : 1200, bounds);
    ASSERT_FALSE(made);
    EXPECT_NE(made.error().message.find("180"), std::string::npos) << made.error().message;
  }
  // The rows may begin anywhere, also round the whole planet.
  const auto band = plan(3600, 1200, degrees(-180.0, -60.04, 180.0, 59.96));
  ASSERT_TRUE(band) << band.error().message;
  EXPECT_TRUE(band->wraps);
  EXPECT_EQ(band->grid.west_deg, -180.0);
  EXPECT_NEAR(band->grid.north_deg, 90.06, 1e-9);
  EXPECT_FALSE(band->grid.reduced);
}

TEST(CutPlanTest, BoundsWithFewDecimalsFit) {
  // Pixels of 1/60 degree; -10.016667 is 0.00002 pixels off.
  const auto made = plan(600, 300, degrees(-10.016667, 40.0, -0.016667, 45.0));
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_NEAR(made->pixel_deg, 1.0 / 60.0, 1e-15);
  EXPECT_EQ(made->finest.x0, 10199);
}

TEST(CutPlanTest, BoundsOffThePlanetOrInsideOutAreRefused) {
  for (const GeoRect& bounds :
       {degrees(0, 10, 20, 0), degrees(-190, 0, -170, 10), degrees(0, 85, 20, 95), degrees(0, 0, 0, 0)}) {
    EXPECT_FALSE(plan(200, 100, bounds));
  }
}

TEST(CutPlanTest, PicturesThatCross180LieOnBothSidesOfIt) {
  const auto made = plan(200, 100, degrees(170, 0, -170, 10));
  ASSERT_TRUE(made) << made.error().message;
  const auto pieces = pieces_of(*made);
  ASSERT_EQ(pieces.size(), 2U);
  EXPECT_EQ(pieces[0].plan.finest.x0, 3500);
  EXPECT_EQ(pieces[0].plan.finest.x1, 3600);
  EXPECT_EQ(pieces[1].plan.finest.x0, 0);
  EXPECT_EQ(pieces[1].plan.finest.x1, 100);
  EXPECT_EQ(pieces[1].first_column, 100);
  EXPECT_NEAR(made->grid.bounds.east.deg(), -170.0, 1e-9);
  EXPECT_GT(made->grid.bounds.west, made->grid.bounds.east);
}

TEST(CutPlanTest, CrossingFromBothSidesIntoOneTileIsRefused) {
  const auto made = plan(3400, 100, degrees(10, 0, -10, 10));
  ASSERT_FALSE(made);
  EXPECT_NE(made.error().message.find("same tile"), std::string::npos);
}

TEST(CutPlanTest, TileSizesAreEvenAndInRange) {
  for (const int tile_px : {0, -2, 14, 17, 4098}) EXPECT_FALSE(plan(64, 32, {}, tile_px)) << tile_px;
  for (const int tile_px : {16, 18, 4096}) EXPECT_TRUE(plan(64, 32, {}, tile_px)) << tile_px;
}

TEST(CutPlanTest, MoreLevelsThanThereAreIsAnError) {
  const auto made = plan(32, 32, degrees(0, 0, 0.00001, 0.00001), 16);
  ASSERT_FALSE(made);
  EXPECT_NE(made.error().message.find("levels"), std::string::npos);
}

TEST(CutPlanTest, RowAreasAddUpToThePlanets) {
  for (const std::int64_t width : {64, 135}) {
    const auto made = plan(width, width / 2);
    double sum = 0.0;
    for (std::int64_t y = 0; y < made->finest.y1; ++y) sum += finest_row_area(*made, y);
    EXPECT_NEAR(sum, 2.0, 1e-14);  // sin 90° - sin -90°, to rounding
  }
}

}  // namespace
}  // namespace terrella::test
