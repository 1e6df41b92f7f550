#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "cut_files.h"
#include "streaming/sets/open_tile_set.h"

namespace terrella::test {
namespace {

namespace fs = std::filesystem;

class Mosaic : public testing::Test {
 protected:
  /// Writes part of the picture, with a world file of its place if the pixels' size is given.
  fs::path write_part(const std::string& name, int x0, int y0, int width, int height, double pixel_deg = 0.0) {
    const fs::path path = folder_ / name;
    write_png(path, part_of(picture_, x0, y0, width, height));
    if (pixel_deg == 0.0) return path;
    fs::path world = path;
    std::ofstream(world.replace_extension(".pgw"))
        << fmt::format("{0}\n0\n0\n-{0}\n{1}\n{2}\n", pixel_deg, west_deg_ + (x0 + 0.5) * pixel_deg,
                       north_deg_ - (y0 + 0.5) * pixel_deg);
    return path;
  }

  std::vector<fs::path> nasa_parts() {
    std::vector<fs::path> parts;
    for (int i = 0; i < 8; ++i) {
      const int x = i % 4;
      const int y = i / 4;
      parts.push_back(
          write_part(fmt::format("world.200412.3x128x128.{}{}.png", "ABCD"[x], y + 1), x * 32, y * 32, 32, 32));
    }
    return parts;
  }

  std::map<TileId, std::vector<std::byte>> cut_whole(std::optional<GeoRect> bounds = {}) {
    write_png(folder_ / "whole.png", picture_);
    must_cut({.images = {folder_ / "whole.png"}, .output = folder_ / "whole.gpkg", .tile_px = 16, .bounds = bounds});
    return all_tiles(folder_ / "whole.gpkg");
  }

  void expect_equals_whole(const std::vector<fs::path>& parts, std::optional<MosaicGrid> grid = {},
                           std::optional<GeoRect> bounds = {}) {
    if (!must_cut({.images = parts, .output = folder_ / "out.gpkg", .tile_px = 16, .mosaic = grid})) return;
    EXPECT_TRUE(all_tiles(folder_ / "out.gpkg") == cut_whole(bounds));
  }

  void refuse(const std::vector<fs::path>& parts, const std::vector<std::string>& said,
              std::optional<MosaicGrid> grid = {}) {
    expect_refused({.images = parts, .output = folder_ / "out.gpkg", .tile_px = 16, .mosaic = grid}, said);
  }

  ScratchFolder folder_;
  Image picture_ = noise(128, 64);
  double west_deg_ = -180.0;
  double north_deg_ = 90.0;
};

TEST_F(Mosaic, EightPartsOfNasasNamesAreTheWhole) { expect_equals_whole(nasa_parts()); }

TEST_F(Mosaic, NamesCountAndNotTheOrder) {
  auto parts = nasa_parts();
  std::ranges::reverse(parts);
  std::swap(parts[1], parts[6]);
  expect_equals_whole(parts);
}

TEST_F(Mosaic, NamesOfFewerPartsAreARegion) {
  const auto parts = nasa_parts();
  ASSERT_TRUE(must_cut({.images = {parts[1], parts[2]}, .output = folder_ / "out.gpkg", .tile_px = 16}));
  const auto tiles = open_tile_set(folder_ / "out.gpkg");
  ASSERT_TRUE(tiles);
  const GeoRect& bounds = (*tiles)->info().grid.bounds;
  constexpr double kPlace_deg = 1e-9;  // 0.1 mm on Earth
  EXPECT_NEAR(bounds.west.deg(), -90.0, kPlace_deg);
  EXPECT_NEAR(bounds.east.deg(), 90.0, kPlace_deg);
  EXPECT_NEAR(bounds.south.deg(), 0.0, kPlace_deg);
}

TEST_F(Mosaic, NamesThatLackOneOrHaveOneTwiceAreRefused) {
  auto parts = nasa_parts();
  const fs::path twin = write_part("again.B1.png", 0, 0, 32, 32);
  parts.push_back(twin);
  refuse(parts, {"again.B1.png (picture 9)", "B1"});
  parts.pop_back();
  parts.erase(parts.begin() + 5);
  refuse(parts, {"lacks", "B2"});
  parts.insert(parts.begin() + 5, write_part("small.B2.png", 0, 0, 31, 32));
  refuse(parts, {"small.B2.png (picture 6)", "31x32"});
}

TEST_F(Mosaic, GridByOrderIsTheWholeAlsoWithUnequalColumns) {
  expect_equals_whole({write_part("a.png", 0, 0, 50, 20), write_part("b.png", 50, 0, 78, 20),
                       write_part("c.png", 0, 20, 50, 44), write_part("d.png", 50, 20, 78, 44)},
                      MosaicGrid{2, 2});
}

TEST_F(Mosaic, GridThatDoesNotFitSaysWhich) {
  const fs::path a = write_part("a.png", 0, 0, 64, 32);
  const fs::path b = write_part("b.png", 64, 0, 64, 31);
  const fs::path c = write_part("c.png", 0, 32, 63, 32);
  refuse({a, b}, {"b.png (picture 2)", "31", "32"}, MosaicGrid{2, 1});
  refuse({a, c}, {"c.png (picture 2)", "63", "64"}, MosaicGrid{1, 2});
  refuse({a, b, c}, {"4 pictures, not 3"}, MosaicGrid{2, 2});
}

TEST_F(Mosaic, WorldFilesPlaceThePartsInAnyOrder) {
  west_deg_ = 10.0;
  north_deg_ = 50.0;
  constexpr double kPixel_deg = 0.125;
  expect_equals_whole(
      {write_part("se.png", 50, 20, 78, 44, kPixel_deg), write_part("nw.png", 0, 0, 40, 20, kPixel_deg),
       write_part("ne.png", 40, 0, 88, 20, kPixel_deg), write_part("sw.png", 0, 20, 50, 44, kPixel_deg)},
      {},
      GeoRect{.west = Angle::degrees(10.0),
              .south = Angle::degrees(42.0),
              .east = Angle::degrees(26.0),
              .north = Angle::degrees(50.0)});
}

TEST_F(Mosaic, WorldFilesThatDoNotFitSayWhich) {
  const fs::path a = write_part("a.png", 0, 0, 64, 64, 2.8125);
  refuse({a, write_part("gap.png", 66, 0, 62, 64, 2.8125)}, {"gap.png (picture 2)", "2 pixels east"});
  refuse({a, write_part("over.png", 60, 0, 68, 64, 2.8125)}, {"over.png (picture 2)", "-4 pixels east"});
  refuse({a, write_part("coarse.png", 64, 0, 64, 64, 2.0)}, {"coarse.png (picture 2)", "pixels"});
  refuse({a, write_part("nowhere.png", 64, 0, 64, 64)}, {"nowhere.png (picture 2)", "‹mosaic›"});
}

TEST_F(Mosaic, GeoTiffTagsPlaceOnePictureToo) {
  write_png(folder_ / "in.png", picture_);
  const std::string command =
      fmt::format("{} -q -a_srs EPSG:4326 -a_ullr 10 50 26 42 '{}' '{}' 2> /dev/null", TERRELLA_GDAL_TRANSLATE,
                  (folder_ / "in.png").string(), (folder_ / "in.tif").string());
  ASSERT_EQ(std::system(command.c_str()), 0);
  ASSERT_TRUE(must_cut({.images = {folder_ / "in.tif"}, .output = folder_ / "out.gpkg", .tile_px = 16}));
  EXPECT_TRUE(all_tiles(folder_ / "out.gpkg") == cut_whole(GeoRect{.west = Angle::degrees(10.0),
                                                                   .south = Angle::degrees(42.0),
                                                                   .east = Angle::degrees(26.0),
                                                                   .north = Angle::degrees(50.0)}));
}

TEST_F(Mosaic, OneTransparentPartMakesPngs) {
  const fs::path a = write_part("a.png", 0, 0, 64, 64);
  write_png(folder_ / "b.png", noise(64, 64, true));
  ASSERT_TRUE(must_cut(
      {.images = {a, folder_ / "b.png"}, .output = folder_ / "out", .tile_px = 16, .mosaic = MosaicGrid{2, 1}}));
  EXPECT_TRUE(fs::exists(folder_ / "out/0/0/0.png"));
}

}  // namespace
}  // namespace terrella::test
