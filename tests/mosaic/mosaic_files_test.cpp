#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "tests/mosaic/cells.h"
#include "tests/raster/raster_files.h"

namespace terrella::test {
namespace {

/// Cells of 1°, 16 pixels a side: columns east of 10°, rows south of 50°.
void write_cells(const ScratchFolder& folder, int columns, int rows) {
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      write_cell(folder / fmt::format("cell-{:02}-{:02}.tif", row, column),
                 {.west_deg = 10.0 + column, .north_deg = 50.0 - row},
                 [&](int x, int y) { return 100 * row + column + x + y; });
    }
  }
}

/// The finest tile at a place.
TileId tile_at(const TileGrid& grid, double lat_deg, double lon_deg) {
  const TileXY at = tile_xy(grid, grid.max_level, lat_deg, lon_deg);
  return {.level = grid.max_level, .x = static_cast<std::int64_t>(at.x), .y = static_cast<std::int64_t>(at.y)};
}

TEST(MosaicFilesTest, ATileOpensTheFilesUnderItAlone) {
  const ScratchFolder folder;
  write_cells(folder, 20, 20);
  const auto tiles = must_open(folder.path(), {.tile_px = 16});
  EXPECT_EQ(tiles->facts().files, 400);
  EXPECT_EQ(tiles->facts().sheets, 1);
  EXPECT_EQ(tiles->times_opened(), 0);
  (void)must_read(*tiles, tile_at(tiles->info().grid, 45.5, 15.5));
  EXPECT_LE(tiles->times_opened(), 9);  // the cell, and those that the filter reaches into
  EXPECT_GE(tiles->times_opened(), 1);
}

TEST(MosaicFilesTest, ASecondStartReadsNoHeaderAndItsOverviewOpensNoFile) {
  const ScratchFolder folder, cache;
  write_cells(folder, 20, 20);
  const MosaicOptions options{.tile_px = 16, .most_open = 8, .store = cache / "cells.mosaic"};
  Block first;
  {
    const auto tiles = must_open(folder.path(), options);
    EXPECT_EQ(tiles->facts().headers_read, 400);
    first = must_read(*tiles, tile_at(tiles->info().grid, 45.5, 15.5));
    for (const TileId& id : tiles_of(tiles->info().grid, 0)) first = must_read(*tiles, id);
    EXPECT_GE(tiles->times_opened(), 400);
  }
  const auto again = must_open(folder.path(), options);
  EXPECT_EQ(again->facts().headers_read, 0);
  Block kept;
  for (const TileId& id : tiles_of(again->info().grid, 0)) kept = must_read(*again, id);
  EXPECT_EQ(again->times_opened(), 0);
  EXPECT_EQ(difference(first, kept).largest, 0.0);
  EXPECT_EQ(difference(first, kept).one_only, 0);
}

TEST(MosaicFilesTest, AChangedFileIsReadAgain) {
  const ScratchFolder folder, cache;
  write_cells(folder, 4, 4);
  const MosaicOptions options{.tile_px = 16, .store = cache / "cells.mosaic"};
  { (void)must_read(*must_open(folder.path(), options), {.level = 0, .x = 1, .y = 0}); }
  write_cell(folder / "cell-02-02.tif", {.west_deg = 12.0, .north_deg = 48.0, .width_px = 16, .height_px = 16},
             [](int, int) { return 5000; });
  std::filesystem::last_write_time(folder / "cell-02-02.tif", std::filesystem::file_time_type::clock::now());
  const auto tiles = must_open(folder.path(), options);
  EXPECT_EQ(tiles->facts().headers_read, 1);
  const auto block = must_read(*tiles, tile_at(tiles->info().grid, 47.5, 12.5));
  EXPECT_TRUE(std::ranges::any_of(std::get<Numbers>(block).values, [](float v) { return v == 5000.0F; }));
}

TEST(MosaicFilesTest, FilesThatCannotBeReadAreNamedAndTheOthersShown) {
  const ScratchFolder folder;
  write_cells(folder, 3, 1);
  std::ofstream(folder / "notes.tif") << "this is no TIFF";
  std::filesystem::resize_file(folder / "cell-00-01.tif", 60);
  std::vector<std::string> said;
  const auto tiles =
      must_open(folder.path(), {.remark = [&said](const std::string& reason) { said.push_back(reason); }});
  EXPECT_EQ(tiles->facts().files, 2);
  EXPECT_EQ(tiles->facts().left_out, 2);
  for (const char* name : {"notes.tif", "cell-00-01.tif", "2 of 4"}) {
    EXPECT_TRUE(std::ranges::any_of(said, [name](const std::string& line) {
      return line.find(name) != std::string::npos;
    })) << name;
  }
}

TEST(MosaicFilesTest, PixelsThatCannotBeReadAreNamedOnce) {
  const ScratchFolder folder;
  write_cells(folder, 2, 1);
  std::filesystem::resize_file(folder / "cell-00-01.tif", 500);  // the header is whole
  std::vector<std::string> said;
  int left_out = 0;
  const auto tiles = must_open(folder.path(), {.left_out = [&left_out](int files) { left_out += files; },
                                               .remark = [&said](const std::string& why) { said.push_back(why); }});
  const auto& grid = tiles->info().grid;
  for (int i = 0; i < 2; ++i) (void)must_read(*tiles, tile_at(grid, 49.5, 11.5));
  ASSERT_EQ(said.size(), 1U);
  EXPECT_NE(said[0].find("cell-00-01.tif"), std::string::npos) << said[0];
  EXPECT_EQ(left_out, 1);
  const auto block = must_read(*tiles, tile_at(grid, 49.5, 10.5));
  EXPECT_TRUE(std::ranges::any_of(std::get<Numbers>(block).values, [](float v) { return v > 0.0F; }));
}

TEST(MosaicFilesTest, PicturesAndNumbersAreNotMixed) {
  const ScratchFolder folder;
  write_cells(folder, 1, 1);
  write_raw(folder / "raw", "Byte", 8, 8, 3, [](int x, int, int) { return 10.0 * x; });
  ASSERT_TRUE(translate("-a_srs EPSG:4326 -a_ullr 5 50 6 49", folder / "raw", folder / "picture.tif"));
  const auto tiles = open_mosaic(folder.path(), {});
  ASSERT_FALSE(tiles);
  EXPECT_NE(tiles.error().message.find("picture.tif"), std::string::npos) << tiles.error().message;
  EXPECT_NE(tiles.error().message.find("cell-00-00.tif"), std::string::npos) << tiles.error().message;
}

TEST(MosaicFilesTest, HeightsInFeetBecomeMetresAndOtherUnitsAreRefused) {
  const ScratchFolder folder;
  write_cell(folder / "feet.tif", {.west_deg = 10.0, .north_deg = 50.0, .unit = "ft"}, [](int, int) { return 1000; });
  const auto tiles = must_open(folder.path(), {.pixels = MosaicPixels::heights});
  const auto value = tiles->value_at({.lat = Angle::degrees(49.5), .lon = Angle::degrees(10.5)}, earth().ellipsoid);
  ASSERT_TRUE(value) << value.error().why;
  EXPECT_NEAR(*value, 304.8, 1e-3);  // a float has 24 bits
  write_cell(folder / "warm.tif", {.west_deg = 11.0, .north_deg = 50.0, .unit = "K"}, [](int, int) { return 280; });
  const auto refused = open_mosaic(folder.path(), {.pixels = MosaicPixels::heights});
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("warm.tif"), std::string::npos) << refused.error().message;
  EXPECT_NE(refused.error().message.find("\"K\""), std::string::npos) << refused.error().message;
}

// A planet whose pixels' middles lie on both poles, as ETOPO has them, with bounds that were rounded outwards.
TEST(MosaicFilesTest, RowsOfPolesMayLieBeyondThemByRounding) {
  const ScratchFolder folder;
  const auto value = [](int x, int y) { return 10 * x + y; };
  const Cell exact{.west_deg = -182.5, .north_deg = 92.5, .pixel_deg = 5.0, .width_px = 72, .height_px = 37};
  Cell rounded = exact;
  rounded.pixel_deg += 1e-5;  // beyond both poles
  rounded.north_deg += 2e-4;
  std::filesystem::create_directories(folder / "exact");
  std::filesystem::create_directories(folder / "rounded");
  write_cell(folder / "exact/etopo.tif", exact, value);
  write_cell(folder / "rounded/etopo.tif", rounded, value);
  const auto a = must_open(folder / "exact", {.tile_px = 16}), b = must_open(folder / "rounded", {.tile_px = 16});
  ASSERT_EQ(a->info().grid.max_level, b->info().grid.max_level);
  for (const TileId& id : tiles_of(a->info().grid, a->info().grid.max_level)) {
    const BlockDifference found = difference(must_read(*a, id), must_read(*b, id));
    EXPECT_EQ(found.one_only, 0);
    EXPECT_LE(found.largest, 0.1);  // rows lie 4e-5 pixels apart, columns 1.4e-4 by the end, where a step is 710
  }
}

TEST(MosaicFilesTest, ListsAndDescriptionsNameFilesAndFolders) {
  const ScratchFolder folder;
  write_cells(folder, 4, 1);
  std::filesystem::create_directory(folder / "more");
  write_cell(folder / "more/south.tif", {.west_deg = 10.0, .north_deg = 49.0}, [](int, int) { return 7; });
  std::ofstream(folder / "some.txt") << "# two cells and a folder\ncell-00-00.tif\r\ncell-00-02.tif\nmore\n";
  EXPECT_EQ(must_open(folder / "some.txt")->facts().files, 3);
  std::ofstream(folder / "some.json") << R"({"name": "Some", "mosaic": ["cell-00-03.tif",
      {"file": "cell-00-01.tif", "crs": "EPSG:4326", "bounds": [20, 30, 21, 31], "scale": 2, "offset": 1}]})";
  const auto described = must_open(folder / "some.json");
  EXPECT_EQ(described->info().name, "Some");
  const auto value =
      described->value_at({.lat = Angle::degrees(30.99), .lon = Angle::degrees(20.01)}, earth().ellipsoid);
  ASSERT_TRUE(value) << value.error().why;
  EXPECT_EQ(*value, 3.0);  // 2 · 1 + 1
  std::ofstream(folder / "wrong.json") << R"({"mosaic": [{"path": "a.tif"}]})";
  const auto wrong = open_mosaic(folder / "wrong.json", {});
  ASSERT_FALSE(wrong);
  EXPECT_NE(wrong.error().message.find("\"path\""), std::string::npos) << wrong.error().message;
  EXPECT_TRUE(is_mosaic(folder.path()));
  std::ofstream(folder / "tileset.json") << "{}";
  EXPECT_FALSE(is_mosaic(folder.path()));
}

TEST(MosaicFilesTest, ATileBetweenPicturesIsClearAndNotMissing) {
  const ScratchFolder folder;
  for (const int west : {10, 20}) {
    write_raw(folder / "raw", "Byte", 16, 16, 3, [](int, int, int) { return 200.0; });
    ASSERT_TRUE(translate(fmt::format("-a_srs EPSG:4326 -a_ullr {} 50 {} 49", west, west + 1), folder / "raw",
                          folder / fmt::format("{}.tif", west)));
  }
  const auto tiles = must_open(folder.path(), {.tile_px = 16});
  const auto between = tiles->read(tile_at(tiles->info().grid, 49.5, 15.5));
  ASSERT_TRUE(between) << between.error().why;
  const auto picture = between->make_picture();
  ASSERT_TRUE(picture);
  EXPECT_EQ(picture->rgba, std::vector<std::uint8_t>(16 * 16 * 4));
}

}  // namespace
}  // namespace terrella::test
