#include "tiles/elevation_source.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "../streaming/streaming_test_support.h"
#include "elevation_files.h"
#include "streaming/cut.h"
#include "streaming/sets/open_tile_set.h"

namespace terrella::test {
namespace {

namespace fs = std::filesystem;

/// 24 bits of 11 km.
constexpr double kFloat_m = 0.001;

class ElevationSets : public testing::Test {
 protected:
  void cut_heights(const std::string& from, const std::string& to, const CutElevation& elevation) {
    const auto made = cut({.images = {folder_ / from},
                           .output = folder_ / to,
                           .tile_px = 16,
                           .format = {},
                           .elevation = elevation,
                           .bounds = {},
                           .name = {},
                           .attribution = {},
                           .body = {},
                           .progress = {}});
    ASSERT_TRUE(made) << made.error().message;
  }
  ScratchFolder folder_;
};

TEST_F(ElevationSets, WhatTheCutterWritesComesBackFromGeoPackageAndFolder) {
  const Raster raster = random_raster(64, 32, 0, 65535);
  write_raster(folder_ / "in.png", raster, "UInt16");
  cut_heights("in.png", "out.gpkg", {.scale = 0.25, .offset = -1000.0, .nodata = 777.0});
  cut_heights("in.png", "tiles", {.scale = 0.25, .offset = -1000.0, .nodata = 777.0});
  for (const char* name : {"out.gpkg", "tiles"}) {
    const auto source = must_open(folder_ / name);
    ASSERT_TRUE(source);
    EXPECT_EQ(source->tiles()->info().numbers->nodata, 777.0);
    for_each_height(*source, raster, [&](std::int64_t x, std::int64_t y, double height_m) {
      EXPECT_EQ(height_m, raster.at(x, y) == 777.0 ? 0.0 : raster.at(x, y) * 0.25 - 1000.0) << name;
    });
  }
}

TEST_F(ElevationSets, WhatIsNotKnownLiesAmongItsNeighboursAndIsCounted) {
  Raster raster = random_raster(64, 32, -500, 9000);
  std::ranges::fill(raster.values.begin(), raster.values.begin() + 16, -9999.0);
  write_raster(folder_ / "in.tif", raster, "Int16", "-9999");
  cut_heights("in.tif", "out.gpkg", {});
  const auto source = must_open(folder_ / "out.gpkg");
  ASSERT_TRUE(source);
  const auto tile = source->read({.level = source->grid().max_level, .x = 0, .y = 0});
  ASSERT_TRUE(tile) << tile.error().why;
  EXPECT_EQ(tile->unknown, 16U);
  // The raster's heights are in [-500, 9000]; what stands for "unknown" is far below.
  EXPECT_GE(*std::ranges::min_element(tile->heights_m), -500.0F);
  EXPECT_EQ(tile->min_m, *std::ranges::min_element(tile->heights_m));
  EXPECT_EQ(tile->max_m, *std::ranges::max_element(tile->heights_m));
}

TEST_F(ElevationSets, GdalsWholeNumbersComeBackAsTheyAre) {
  const Raster raster = random_raster(512, 256, -32000, 32000);
  write_raster(folder_ / "in.tif", raster, "Int16");
  write_gdal_geopackage(folder_ / "in.tif", folder_ / "gdal.gpkg");
  add_overviews(folder_ / "gdal.gpkg");
  const auto source = must_open(folder_ / "gdal.gpkg");
  ASSERT_TRUE(source);
  EXPECT_EQ(source->grid().max_level, source->grid().min_level + 1) << "with an overview";
  std::int64_t wrong = 0;
  for_each_height(*source, raster, [&](std::int64_t x, std::int64_t y, double height_m) {
    if (height_m != raster.at(x, y)) ++wrong;
  });
  EXPECT_EQ(wrong, 0);
}

TEST_F(ElevationSets, GdalsFloatsComeBackFromTiffTiles) {
  Raster raster = random_raster(512, 256, -32000, 32000);
  for (double& value : raster.values) value *= 0.3;
  raster.values[5] = -9999.0;
  write_raster(folder_ / "in.tif", raster, "Float32", "-9999");
  write_gdal_geopackage(folder_ / "in.tif", folder_ / "gdal.gpkg");
  const auto source = must_open(folder_ / "gdal.gpkg");
  ASSERT_TRUE(source);
  EXPECT_TRUE(source->tiles()->info().numbers->floats);
  double worst_m = 0.0;
  for_each_height(*source, raster, [&](std::int64_t x, std::int64_t y, double height_m) {
    if (raster.at(x, y) != -9999.0) worst_m = std::max(worst_m, std::abs(height_m - raster.at(x, y)));
  });
  EXPECT_LT(worst_m, kFloat_m);
  EXPECT_EQ(source->read({.level = source->grid().max_level, .x = 0, .y = 0})->unknown, 1U);
}

/// GDAL gives each tile a scale and an offset of its own.
TEST_F(ElevationSets, GdalsFloatsInPngTilesComeBackByTheirTilesScale) {
  Raster raster = random_raster(512, 256, 0, 1000);
  for (std::size_t i = 0; i < raster.values.size(); ++i) raster.values[i] += i % 512 < 256 ? 0.5 : 20000.0;
  write_raster(folder_ / "in.tif", raster, "Float32");
  write_gdal_geopackage(folder_ / "in.tif", folder_ / "gdal.gpkg", "-co TILE_FORMAT=PNG");
  const auto source = must_open(folder_ / "gdal.gpkg");
  ASSERT_TRUE(source);
  EXPECT_FALSE(source->tiles()->info().numbers->floats);
  constexpr double kHalfStep_m = 0.5 * 1000.0 / 65535.0;
  double worst_m = 0.0;
  for_each_height(*source, raster, [&](std::int64_t x, std::int64_t y, double height_m) {
    worst_m = std::max(worst_m, std::abs(height_m - raster.at(x, y)));
  });
  EXPECT_LT(worst_m, kHalfStep_m + kFloat_m);
}

TEST_F(ElevationSets, PicturesBesideHeightsAreStillTheTileSet) {
  write_raster(folder_ / "in.tif", random_raster(512, 256, 0, 9), "Int16");
  write_raster(folder_ / "in.png", random_raster(512, 256, 0, 255), "Byte");
  write_gdal_geopackage(folder_ / "in.tif", folder_ / "both.gpkg", "-co RASTER_TABLE=a_heights");
  write_gdal_geopackage(folder_ / "in.png", folder_ / "both.gpkg",
                        "-co APPEND_SUBDATASET=YES -co RASTER_TABLE=b_pictures -co TILE_FORMAT=PNG -a_ullr -180 90 180 "
                        "-90 -a_srs EPSG:4326");
  const auto tiles = open_tile_set(folder_ / "both.gpkg");
  ASSERT_TRUE(tiles) << tiles.error().message;
  EXPECT_FALSE((*tiles)->info().numbers);
}

}  // namespace
}  // namespace terrella::test
