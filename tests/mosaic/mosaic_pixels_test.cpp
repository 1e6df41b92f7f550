#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "streaming/warp/warp_source.h"
#include "tests/mosaic/cells.h"
#include "tests/raster/raster_files.h"

namespace terrella::test {
namespace {

constexpr int kSide_px = 512;

/// A gradient with waves of 24 pixels, so that a seam would show.
double wavy(int x, int y, int band) {
  return 20.0 + 0.3 * x + 0.05 * y + 10.0 * band + 15.0 * std::sin(x / 3.8) * std::cos(y / 3.8);
}

/// A square picture in UTM zone 33, 60 km a side, and the 16 parts that it was cut into.
struct CutPicture {
  CutPicture(const std::string& type, int bands) {
    std::filesystem::create_directory(folder / "parts");
    write_raw(folder / "raw", type, kSide_px, kSide_px, bands, wavy);
    const bool made = translate("-a_srs EPSG:32633 -a_ullr 500000 5560000 560000 5500000", folder / "raw", whole());
    EXPECT_TRUE(made);
    for (int part = 0; part < 16; ++part) {
      const std::string window = fmt::format("-srcwin {} {} 128 128", part % 4 * 128, part / 4 * 128);
      EXPECT_TRUE(translate(window, whole(), folder / fmt::format("parts/part-{:02}.tif", part)));
    }
  }
  [[nodiscard]] std::filesystem::path whole() const { return folder / "whole.tif"; }
  const ScratchFolder folder;
};

std::unique_ptr<TileSource> warped_whole(const CutPicture& picture, bool numbers, int tile_px) {
  const CrsPlace place{.to_crs = {500000.0, 60000.0 / kSide_px, 0.0, 5560000.0, 0.0, -60000.0 / kSide_px},
                       .crs = "EPSG:32633"};
  auto raster = open_raster(picture.whole(), place, {.heights = numbers});
  EXPECT_TRUE(raster);
  auto tiles =
      warp_source(*std::move(raster), {.figure = {.ellipsoid = earth().ellipsoid}, .tile_px = tile_px}, "whole");
  EXPECT_TRUE(tiles);
  return *std::move(tiles);
}

void expect_equal_levels(MosaicTiles& parts, TileSource& whole, double tolerance) {
  ASSERT_EQ(parts.info().grid, whole.info().grid);
  const TileGrid& grid = whole.info().grid;
  std::int64_t compared = 0;
  for (int level = grid.max_level; level >= grid.max_level - 3; --level) {
    for (const TileId& id : tiles_of(grid, level)) {
      const BlockDifference found = difference(must_read(parts, id), must_read(whole, id));
      EXPECT_LE(found.largest, tolerance) << id.level << "/" << id.x << "/" << id.y;
      EXPECT_EQ(found.one_only, 0) << id.level << "/" << id.x << "/" << id.y;
      compared += found.shared;
    }
  }
  EXPECT_GT(compared, kSide_px * kSide_px);
}

// Both go through the same filter, so that rounding is all that may differ: one level.
TEST(MosaicPixelsTest, SixteenPartsEqualThePictureTheyWereCutFrom) {
  const CutPicture picture("Byte", 3);
  const auto parts = must_open(picture.folder / "parts", {.tile_px = 128});
  EXPECT_EQ(parts->facts().sheets, 1);
  expect_equal_levels(*parts, *warped_whole(picture, false, 128), 1.0);
}

TEST(MosaicPixelsTest, SixteenPartsEqualTheNumbersTheyWereCutFrom) {
  const CutPicture picture("Float32", 1);
  const auto parts = must_open(picture.folder / "parts", {.tile_px = 128});
  // Sums of floats of some hundred: 24 bits.
  expect_equal_levels(*parts, *warped_whole(picture, true, 128), 1e-3);
}

// Overviews of 121 pixels have 61: they are no part of a common grid.
TEST(MosaicPixelsTest, OverviewsOfOddSizesJoinWithoutAGap) {
  const ScratchFolder folder;
  for (int cell = 0; cell < 4; ++cell) {
    const double west = 10.0 + cell % 2, north = 50.0 - cell / 2;
    const auto path = folder / fmt::format("cell-{}.tif", cell);
    write_cell(path,
               {.west_deg = west - 1.0 / 240.0,
                .north_deg = north + 1.0 / 240.0,
                .pixel_deg = 1.0 / 120.0,
                .width_px = 121,
                .height_px = 121},
               [&](int x, int y) { return 1000 + 2 * (cell % 2 * 120 + x) + 3 * (cell / 2 * 120 + y); });
    ASSERT_TRUE(add_overviews("-r average", path, "2 4"));
  }
  const auto tiles = must_open(folder.path(), {.tile_px = 32});
  const TileGrid& grid = tiles->info().grid;
  for (int level = grid.max_level - 3; level <= grid.max_level; ++level) {
    const double pixel_deg = tile_span_deg(grid, level) / grid.tile_px;
    std::int64_t checked = 0;
    for (const TileId& id : tiles_of(grid, level)) {
      const auto block = must_read(*tiles, id);
      const TileBounds at = tile_bounds(grid, id);
      for (int i = 0; i < 32 * 32; ++i) {
        const double lon = at.west_deg + (i % 32 + 0.5) * pixel_deg, lat = at.north_deg - (i / 32 + 0.5) * pixel_deg;
        // Away from the outer edge, where a pixel is not covered whole.
        if (lon < 10.0 + pixel_deg || lon > 12.0 - pixel_deg || lat > 50.0 - pixel_deg || lat < 48.0 + pixel_deg)
          continue;
        const double truth = 1000.0 + 2.0 * (lon - 10.0) * 120.0 + 3.0 * (50.0 - lat) * 120.0;
        // An overview's pixel lies up to half a pixel of the level before beside its place: 5 units a pixel.
        EXPECT_NEAR(std::get<Numbers>(block).values[i], truth, 5.0 * pixel_deg * 120.0 / 4.0 + 1.0)
            << id.level << " at " << lon << ", " << lat;
        ++checked;
      }
    }
    EXPECT_GT(checked, 0);
  }
}

TEST(MosaicPixelsTest, TheFinestLieOnTopAndThenTheLast) {
  const ScratchFolder folder;
  const auto value_at = [](TileSource& tiles, double lat, double lon) {
    const auto value = tiles.value_at({.lat = Angle::degrees(lat), .lon = Angle::degrees(lon)}, earth().ellipsoid);
    return value ? *value : NAN;
  };
  write_cell(folder / "a-fine.tif", {.west_deg = 10.0, .north_deg = 50.0}, [](int, int) { return 1; });
  write_cell(folder / "b-early.tif", {.west_deg = 10.02, .north_deg = 50.02, .pixel_deg = 0.25},
             [](int, int) { return 2; });
  write_cell(folder / "c-late.tif", {.west_deg = 12.0, .north_deg = 50.0, .pixel_deg = 0.25},
             [](int, int) { return 3; });
  const auto tiles = must_open(folder.path());
  EXPECT_EQ(value_at(*tiles, 49.5, 10.5), 1.0);
  EXPECT_EQ(value_at(*tiles, 49.5, 11.5), 2.0);
  EXPECT_EQ(value_at(*tiles, 49.5, 13.5), 3.0);
  EXPECT_TRUE(std::isnan(value_at(*tiles, 52.0, 13.5)));
  // The drawn tiles agree.
  const TileGrid& grid = tiles->info().grid;
  const TileXY at = tile_xy(grid, grid.max_level, 49.5, 13.5);
  const auto block = must_read(
      *tiles, {.level = grid.max_level, .x = static_cast<std::int64_t>(at.x), .y = static_cast<std::int64_t>(at.y)});
  const auto pixel = [&](double part) { return static_cast<int>((part - std::floor(part)) * grid.tile_px); };
  EXPECT_EQ(std::get<Numbers>(block).values[pixel(at.y) * grid.tile_px + pixel(at.x)], 3.0F);
}

/// Values that gdallocationinfo gives for places, NaN beside the raster.
std::vector<double> told_by_gdal(const std::filesystem::path& raster, const std::vector<CrsPoint>& places,
                                 const ScratchFolder& folder) {
  std::ofstream list(folder / "places.txt");
  for (const CrsPoint& place : places) list << fmt::format("{:.10f} {:.10f}\n", place.x, place.y);
  list.close();
  const std::string command = fmt::format("gdallocationinfo -valonly -wgs84 '{}' < '{}' > '{}'", raster.string(),
                                          (folder / "places.txt").string(), (folder / "values.txt").string());
  static_cast<void>(std::system(command.c_str()));  // fails if a place lies beside the raster
  std::ifstream told(folder / "values.txt");
  std::vector<double> values;
  for (std::string line; std::getline(told, line);) values.push_back(line.empty() ? NAN : std::stod(line));
  return values;
}

TEST(MosaicPixelsTest, HeightsAtTwoHundredPlacesAreThoseOfGdal) {
  const CutPicture picture("Float32", 1);
  const auto tiles = must_open(picture.folder / "parts", {.pixels = MosaicPixels::heights});
  std::vector<CrsPoint> places;
  for (int i = 0; i < 200; ++i) {
    places.push_back({15.02 + 0.78 * noise_at(i, 0, 0), 49.68 + 0.48 * noise_at(i, 1, 0)});
  }
  const auto told = told_by_gdal(picture.whole(), places, picture.folder);
  ASSERT_EQ(told.size(), places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Geodetic place{.lat = Angle::degrees(places[i].y), .lon = Angle::degrees(places[i].x)};
    const auto value = tiles->value_at(place, earth().ellipsoid);
    ASSERT_TRUE(value) << value.error().why;
    EXPECT_NEAR(*value, told[i], 1e-4) << places[i].x << ", " << places[i].y;  // GDAL prints so many digits
  }
}

/// Nine parts of 40 pixels in UTM, of one sample type, that lie up to 0.009 pixels off a common lattice, and one with a
/// scale. GDAL is asked part by part.
class MosaicValues : public testing::TestWithParam<const char*> {};

TEST_P(MosaicValues, AreThoseThatGdalFindsInTheFiles) {
  constexpr double kPixel_m = 100.0;
  constexpr int kPart_px = 40;
  const ScratchFolder folder;
  std::filesystem::create_directory(folder / "parts");
  std::vector<std::filesystem::path> parts;
  for (int part = 0; part < 9; ++part) {
    write_raw(folder / "raw", GetParam(), kPart_px, kPart_px, 1,
              [&](int x, int y, int) { return 100.0 * part + (x * 7 + y * 13) % 97 + 0.3; });
    const double off = 0.009 * kPixel_m * (part % 3 - 1);
    const double west = 500000.0 + part % 3 * kPart_px * kPixel_m + off,
                 north = 5560000.0 - part / 3 * kPart_px * kPixel_m;
    parts.push_back(folder / fmt::format("parts/part-{}.tif", part));
    const std::string how = fmt::format("-a_srs EPSG:32633 -a_ullr {} {} {} {} -a_scale 0.01 -a_offset 273.15", west,
                                        north, west + kPart_px * kPixel_m, north - kPart_px * kPixel_m);
    ASSERT_TRUE(translate(how, folder / "raw", parts.back()));
  }
  const auto tiles = must_open(folder / "parts");
  ASSERT_EQ(tiles->facts().sheets, 1);
  std::vector<CrsPoint> places;
  for (int i = 0; i < 1000; ++i)
    places.push_back({15.002 + 0.155 * noise_at(i, 0, 0), 50.085 + 0.1 * noise_at(i, 1, 0)});
  // The last part lies on top; none of the places lies beside all parts.
  std::vector<double> told(places.size(), NAN);
  for (const auto& part : parts) {
    const auto of_part = told_by_gdal(part, places, folder);
    for (std::size_t i = 0; i < places.size(); ++i) {
      if (std::isfinite(of_part[i])) told[i] = of_part[i];
    }
  }
  int compared = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (std::isnan(told[i])) continue;
    const auto value =
        tiles->value_at({.lat = Angle::degrees(places[i].y), .lon = Angle::degrees(places[i].x)}, earth().ellipsoid);
    ASSERT_TRUE(value) << value.error().why;
    EXPECT_NEAR(*value, told[i] * 0.01 + 273.15, 1e-11) << places[i].x << ", " << places[i].y;
    ++compared;
  }
  EXPECT_GT(compared, 900);
}

INSTANTIATE_TEST_SUITE_P(OfEachType, MosaicValues, testing::Values("Int16", "UInt16", "Int32", "Float32", "Float64"));

}  // namespace
}  // namespace terrella::test
