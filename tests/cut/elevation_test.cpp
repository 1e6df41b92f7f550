#include <fmt/format.h>
#include <gtest/gtest.h>
#include <png.h>
#include <tiffio.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>

#include "cut_files.h"
#include "streaming/sets/open_tile_set.h"

namespace terrella::test {
namespace {

namespace fs = std::filesystem;

template <class T>
struct Heights {
  int width = 0;
  int height = 0;
  std::vector<T> values;
  [[nodiscard]] T at(int x, int y) const { return values[static_cast<std::size_t>(y * width + x)]; }
};

template <class T>
Heights<T> random_heights(int width, int height, double least, double most) {
  std::mt19937 random(7);
  Heights<T> made{width, height, {}};
  for (int i = 0; i < width * height; ++i) {
    made.values.push_back(static_cast<T>(least + (most - least) * static_cast<double>(random() % 10001) / 10000.0));
  }
  return made;
}

void write_gray_png(const fs::path& path, const Heights<std::uint16_t>& heights) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(heights.width);
  image.height = static_cast<png_uint_32>(heights.height);
  image.format = PNG_FORMAT_LINEAR_Y;
  ASSERT_NE(png_image_write_to_file(&image, path.c_str(), 0, heights.values.data(), 0, nullptr), 0);
}

template <class T>
void write_height_tiff(const fs::path& path, const Heights<T>& heights, int format, bool tiled = false) {
  TIFF* tiff = TIFFOpen(path.c_str(), "w");
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, heights.width);
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, heights.height);
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, static_cast<int>(sizeof(T) * 8));
  TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, 1);
  TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, format);
  TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
  constexpr int kTile_px = 16;
  if (tiled) {
    TIFFSetField(tiff, TIFFTAG_TILEWIDTH, kTile_px);
    TIFFSetField(tiff, TIFFTAG_TILELENGTH, kTile_px);
  }
  for (int y = 0; y < heights.height; y += tiled ? kTile_px : 1) {
    if (!tiled) {
      std::vector<T> row(heights.values.begin() + y * heights.width, heights.values.begin() + (y + 1) * heights.width);
      TIFFWriteScanline(tiff, row.data(), static_cast<std::uint32_t>(y), 0);
      continue;
    }
    for (int x = 0; x < heights.width; x += kTile_px) {
      std::vector<T> tile;
      for (int i = 0; i < kTile_px * kTile_px; ++i) {
        tile.push_back(
            heights.at(std::min(x + i % kTile_px, heights.width - 1), std::min(y + i / kTile_px, heights.height - 1)));
      }
      TIFFWriteTile(tiff, tile.data(), static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), 0, 0);
    }
  }
  TIFFClose(tiff);
}

constexpr WholeRange k16Bits{0, 65535};

class Elevation : public testing::Test {
 protected:
  [[nodiscard]] CutOptions options(const std::string& input, const CutElevation& elevation = {},
                                   const std::string& output = "out.gpkg") const {
    return {
        .images = {folder_ / input}, .output = folder_ / output, .tile_px = 16, .elevation = elevation, .force = true};
  }

  [[nodiscard]] NumberInfo described(const std::string& output = "out.gpkg") const {
    const auto tiles = open_tile_set(folder_ / output);
    EXPECT_TRUE(tiles) << tiles.error().message;
    EXPECT_TRUE(tiles && (*tiles)->info().numbers);
    return tiles && (*tiles)->info().numbers ? *(*tiles)->info().numbers : NumberInfo{};
  }

  /// Value that GDAL finds at a pixel, `overview` levels above the finest; NaN: nothing, or nodata.
  [[nodiscard]] double by_gdal(int x, int y, int overview = -1) const {
    const std::string command = fmt::format("{} -valonly {} '{}' {} {} > '{}' 2> '{}'", TERRELLA_GDALLOCATIONINFO,
                                            overview < 0 ? std::string() : fmt::format("-overview {}", overview + 1),
                                            (folder_ / "out.gpkg").string(), x, y, (folder_ / "value.txt").string(),
                                            (folder_ / "value.log").string());
    if (std::system(command.c_str()) != 0) return std::numeric_limits<double>::quiet_NaN();
    std::ifstream text(folder_ / "value.txt");
    double value = std::numeric_limits<double>::quiet_NaN();
    text >> value;
    return value;
  }

  ScratchFolder folder_;
};

TEST_F(Elevation, GdalReadsTheHeightsOfA16BitPng) {
  const auto heights = random_heights<std::uint16_t>(64, 32, 0, 65535);
  write_gray_png(folder_ / "in.png", heights);
  ASSERT_TRUE(must_cut(options("in.png", {.scale = 0.5, .offset = -10000.0})));
  EXPECT_EQ(described(),
            (NumberInfo{
                .scale = 0.5, .offset = -10000.0, .nodata = {}, .whole = k16Bits, .unit = "m", .quantity = "height"}));
  for (const auto& [x, y] : {std::pair{0, 0}, std::pair{63, 31}, std::pair{17, 20}, std::pair{40, 3}}) {
    EXPECT_EQ(by_gdal(x, y), heights.at(x, y) * 0.5 - 10000.0) << x << " " << y;
  }
}

TEST_F(Elevation, MeansAreByAreaAndRoundedOnce) {
  constexpr double kOneRounding = 0.5 + 0.02;  // rounding of numbers up to 65535, in floats of 24 bits
  const auto heights = random_heights<std::uint16_t>(64, 32, 0, 65535);
  write_gray_png(folder_ / "in.png", heights);
  ASSERT_TRUE(must_cut(options("in.png")));
  for (int y = 0; y < 16; ++y) {
    const auto area = [](int row) { return std::cos(row * M_PI / 32.0) - std::cos((row + 1) * M_PI / 32.0); };
    for (int x = 0; x < 32; x += 5) {
      double sum = 0.0;
      for (int i = 0; i < 4; ++i) sum += area(2 * y + i / 2) * heights.at(2 * x + i % 2, 2 * y + i / 2);
      EXPECT_NEAR(by_gdal(2 * x, 2 * y, 0), sum / (2.0 * (area(2 * y) + area(2 * y + 1))), kOneRounding);
    }
    if (y > 3) break;  // one process a pixel
  }
}

TEST_F(Elevation, SignedAndFloatTiffsGiveMetres) {
  const auto whole = random_heights<std::int16_t>(64, 32, -32768, 32767);
  for (const bool tiled : {false, true}) {
    write_height_tiff(folder_ / "in.tif", whole, SAMPLEFORMAT_INT, tiled);
    ASSERT_TRUE(must_cut(options("in.tif")));
    EXPECT_EQ(
        described(),
        (NumberInfo{
            .scale = 1.0, .offset = -32768.0, .nodata = {}, .whole = k16Bits, .unit = "m", .quantity = "height"}));
    EXPECT_EQ(by_gdal(40, 3), whole.at(40, 3));
  }
  const auto real = random_heights<float>(64, 32, -11000.0, 8848.0);
  write_height_tiff(folder_ / "in.tif", real, SAMPLEFORMAT_IEEEFP, true);
  ASSERT_TRUE(must_cut(options("in.tif")));
  const double half_step_m = described().scale * 0.5;
  EXPECT_NEAR(half_step_m, 19848.0 / 65534.0 / 2.0, 0.001);
  constexpr double kFloat_m = 0.002;  // GDAL gives 32-bit floats: 24 bits of 11 km
  for (const int x : {0, 13, 63}) EXPECT_NEAR(by_gdal(x, 7), real.at(x, 7), half_step_m + kFloat_m);
}

TEST_F(Elevation, FloatsAreKeptAsToldAndCutOffAtTheEnds) {
  auto real = random_heights<float>(64, 32, 0.0, 100.0);
  real.values[0] = 1e9F;
  write_height_tiff(folder_ / "in.tif", real, SAMPLEFORMAT_IEEEFP);
  ASSERT_TRUE(must_cut(options("in.tif", {.scale = 0.25, .offset = -10.0})));
  EXPECT_NEAR(by_gdal(9, 9), real.at(9, 9), 0.125 + 1e-5);
  EXPECT_EQ(by_gdal(0, 0), 65534 * 0.25 - 10.0) << "the largest that is not nodata";
}

TEST_F(Elevation, WhereNothingIsKnownHasNoPartInMeans) {
  auto heights = random_heights<std::int16_t>(64, 32, 100, 100);
  for (int i = 0; i < 64 * 32; ++i) {
    if (i / 64 % 2 == 0 || i % 64 >= 32) heights.values[static_cast<std::size_t>(i)] = -9999;
  }
  write_height_tiff(folder_ / "in.tif", heights, SAMPLEFORMAT_INT);
  ASSERT_TRUE(must_cut(options("in.tif", {.nodata = -9999.0})));
  EXPECT_EQ(described().nodata, 32768 - 9999);
  EXPECT_EQ(by_gdal(5, 1), 100.0);
  EXPECT_EQ(by_gdal(5, 0), 32768 - 9999) << "GDAL says nodata by its number";
  EXPECT_EQ(by_gdal(6, 6, 0), 100.0) << "half of it known";
  EXPECT_EQ(by_gdal(50, 6, 0), 32768 - 9999);
}

TEST_F(Elevation, MeansNeverFallOnNodata) {
  auto heights = random_heights<std::uint16_t>(64, 32, 0, 0);
  for (std::size_t i = 0; i < heights.values.size(); ++i) heights.values[i] = i % 2 == 0 ? 499 : 501;
  write_gray_png(folder_ / "in.png", heights);
  ASSERT_TRUE(must_cut(options("in.png", {.nodata = 500.0})));
  EXPECT_EQ(by_gdal(6, 6, 0), 501.0);
}

TEST_F(Elevation, PlanetsByNodesAreTakenBetweenTheNodes) {
  const auto nodes = random_heights<std::uint16_t>(64, 33, 0, 60000);
  write_gray_png(folder_ / "in.png", nodes);
  ASSERT_TRUE(must_cut(options("in.png")));
  for (const auto& [x, y] : {std::pair{0, 0}, std::pair{20, 13}, std::pair{63, 31}}) {
    const int east = (x + 1) % 64;
    const double mean = (nodes.at(x, y) + nodes.at(east, y) + nodes.at(x, y + 1) + nodes.at(east, y + 1)) / 4.0;
    EXPECT_NEAR(by_gdal(x, y), mean, 0.51) << x << " " << y;  // rounded to whole numbers
  }
}

TEST_F(Elevation, FoldersSayTheSame) {
  write_gray_png(folder_ / "in.png", random_heights<std::uint16_t>(64, 32, 0, 65535));
  const CutElevation elevation{.scale = 0.1, .offset = -500.0, .nodata = 7.0};
  ASSERT_TRUE(must_cut(options("in.png", elevation)));
  ASSERT_TRUE(must_cut(options("in.png", elevation, "tiles")));
  EXPECT_EQ(described(), described("tiles"));
  std::ifstream text(folder_ / "tiles/tileset.json");
  const auto json = nlohmann::json::parse(text);
  EXPECT_EQ(json["elevation"],
            (nlohmann::json{{"scale", 0.1}, {"offset", -500.0}, {"nodata", 7}, {"unit", "m"}, {"quantity", "height"}}));
  EXPECT_EQ(json["format"], "png");
  EXPECT_TRUE(all_tiles(folder_ / "out.gpkg") == all_tiles(folder_ / "tiles"));
}

TEST_F(Elevation, WhatIsNoHeightIsRefused) {
  write_png(folder_ / "colour.png", noise(64, 32));
  expect_refused(options("colour.png"), {"colour.png", "16 bits"});
  write_jpeg(folder_ / "in.jpg", noise(64, 32));
  expect_refused(options("in.jpg"), {"in.jpg", "16 bits"});
  write_gray_png(folder_ / "in.png", random_heights<std::uint16_t>(64, 32, 0, 65535));
  expect_refused(options("in.png", {.scale = 0.0}), {"scale"});
  CutOptions jpeg = options("in.png");
  jpeg.format = ImageFormat::jpeg;
  expect_refused(jpeg, {"PNG"});
}

TEST_F(Elevation, PartsOfAMosaicShareOneScale) {
  const auto west = random_heights<float>(32, 32, -100.0, 0.0);
  const auto east = random_heights<float>(32, 32, 0.0, 900.0);
  write_height_tiff(folder_ / "w.tif", west, SAMPLEFORMAT_IEEEFP);
  write_height_tiff(folder_ / "e.tif", east, SAMPLEFORMAT_IEEEFP);
  CutOptions both = options("w.tif");
  both.images.push_back(folder_ / "e.tif");
  both.mosaic = MosaicGrid{2, 1};
  ASSERT_TRUE(must_cut(both));
  EXPECT_NEAR(by_gdal(3, 3), west.at(3, 3), 0.01);
  EXPECT_NEAR(by_gdal(35, 3), east.at(3, 3), 0.01);  // a step is 1000 m / 65534
}

}  // namespace
}  // namespace terrella::test
