#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "streaming/sets/open_tile_set.h"
#include "streaming_test_support.h"
#include "tiles/tile_range.h"
#include "tiles/tile_source.h"

namespace terrella {
namespace {

/// Colours grow by 255 over 360° or 180°: half a pixel of the coarsest level is a level or two, and GDAL 3.6's
/// overviews of PNG tiles are themselves off by up to four. A row or column of tiles in the wrong place is off by 30
/// and more.
constexpr double kPlaceLevels = 6.0;

/// A georeferenced picture whose colours say where they are, and tile sets that GDAL's programs make of it.
class Gdal : public testing::Test {
 protected:
  void SetUp() override {
    test::write_bytes(folder_ / "picture.png", *encode_png(test::place_picture(1024)));
    ASSERT_TRUE(
        run(std::string(GDAL_TRANSLATE) + " -q -a_srs EPSG:4326 -a_ullr -180 90 180 -90 picture.png picture.tif"));
  }

  [[nodiscard]] bool run(const std::string& command) const {
    const std::string in_folder = "cd '" + (folder_ / "").string() + "' && " + command + " >log.txt 2>&1";
    return std::system(in_folder.c_str()) == 0;
  }

  [[nodiscard]] std::unique_ptr<TileSource> open(const std::string& name) const {
    auto source = open_tile_set(folder_ / name);
    EXPECT_TRUE(source) << source.error().message;
    return source ? *std::move(source) : nullptr;
  }

  [[nodiscard]] bool write_geopackage(const std::string& name, const std::string& options) const {
    return run(std::string(GDAL_TRANSLATE) + " -q -of GPKG -co TILE_FORMAT=PNG " + options + " picture.tif " + name) &&
           run(std::string(GDALADDO) + " -q -r average " + name + " 2 4");
  }

  /// Tiles that lie right.
  static int expect_places(TileSource& source) {
    const TileGrid& grid = source.info().grid;
    int tiles = 0;
    for (int level = grid.min_level; level <= grid.max_level; ++level) {
      for_each_place(grid, level, [&](const TileId& id) {
        EXPECT_LE(test::worst_misplacement(grid, id, test::load_tile(source, id)), kPlaceLevels)
            << id.level << "/" << id.x << "/" << id.y;
        ++tiles;
        return true;
      });
    }
    return tiles;
  }

  test::ScratchFolder folder_;
};

TEST_F(Gdal, GeoPackageWithTheDefaultScheme) {
  ASSERT_TRUE(write_geopackage("a.gpkg", ""));
  const auto source = open("a.gpkg");
  ASSERT_TRUE(source);
  EXPECT_EQ(expect_places(*source), 8 + 2 + 1);
}

TEST_F(Gdal, GeoPackageWithTilingSchemes) {
  for (const char* scheme : {"InspireCRS84Quad", "GoogleCRS84Quad", "PseudoTMS_GlobalGeodetic"}) {
    SCOPED_TRACE(scheme);
    const std::string name = std::string(scheme) + ".gpkg";
    ASSERT_TRUE(write_geopackage(name, std::string("-co TILING_SCHEME=") + scheme));
    const auto source = open(name);
    ASSERT_TRUE(source);
    EXPECT_GE(expect_places(*source), 8);
  }
}

TEST_F(Gdal, GeoPackageOfARegionBeginsWhereItsTilesDo) {
  ASSERT_TRUE(run(std::string(GDAL_TRANSLATE) + " -q -of GPKG -a_ullr 11 50 21 45 picture.tif part.gpkg"));
  const auto source = open("part.gpkg");
  ASSERT_TRUE(source);
  const TileGrid& grid = source->info().grid;
  const TileXY corner = tile_xy(grid, grid.max_level, 50.0, 11.0);
  EXPECT_NEAR(corner.x, std::round(corner.x), 1e-6);
  EXPECT_NEAR(corner.y, std::round(corner.y), 1e-6);
  EXPECT_TRUE(source->read({grid.max_level, std::llround(corner.x), std::llround(corner.y)}));
}

TEST_F(Gdal, TilesWithTwoRoots) {
  ASSERT_TRUE(run(std::string(GDAL2TILES) + " -q -p geodetic --tmscompatible -z 0-2 picture.tif two"));
  const auto source = open("two");
  ASSERT_TRUE(source);
  EXPECT_DOUBLE_EQ(source->info().grid.root_span_deg, 180.0);
  EXPECT_EQ(expect_places(*source), 2 + 8 + 32);
}

TEST_F(Gdal, TilesWithOneRoot) {
  ASSERT_TRUE(run(std::string(GDAL2TILES) + " -q -p geodetic -z 0-2 picture.tif one"));
  const auto source = open("one");
  ASSERT_TRUE(source);
  EXPECT_DOUBLE_EQ(source->info().grid.root_span_deg, 360.0);
  EXPECT_EQ(source->info().grid.min_level, 1);
  EXPECT_EQ(expect_places(*source), 2 + 8);
}

}  // namespace
}  // namespace terrella
