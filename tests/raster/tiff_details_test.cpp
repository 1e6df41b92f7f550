#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "raster_files.h"

namespace terrella::test {
namespace {

namespace fs = std::filesystem;

constexpr int kWidth = 150;
constexpr int kHeight = 90;
constexpr const char* kTiles = "-co TILED=YES -co BLOCKXSIZE=64 -co BLOCKYSIZE=64 ";

double gray(int x, int y, int band) { return std::floor(256.0 * noise_at(x, y, band)); }
/// Transparent inside a circle.
bool is_clear(int x, int y) { return (x - 60) * (x - 60) + (y - 40) * (y - 40) < 900; }

std::unique_ptr<RasterSource> opened(const fs::path& path, const RasterOptions& options = {}) {
  auto source = open_raster(path, some_place(), options);
  EXPECT_TRUE(source) << source.error().message;
  return source ? *std::move(source) : nullptr;
}

const std::uint8_t* pixel_of(const Image& image, int x, int y) {
  return image.rgba.data() + static_cast<std::size_t>(y * image.width_px + x) * 4;
}

class Masks : public testing::TestWithParam<std::pair<const char*, const char*>> {};

/// The fourth band of the raw picture becomes a mask. GDAL's mask band is the truth, at all levels.
TEST_P(Masks, MakeTransparent) {
  const ScratchFolder folder;
  write_raw(folder / "in.raw", "Byte", kWidth, kHeight, 4,
            [](int x, int y, int band) { return band == 3 ? (is_clear(x, y) ? 0.0 : 255.0) : gray(x, y, band); });
  const auto& [config, options] = GetParam();
  ASSERT_TRUE(translate(fmt::format("--config GDAL_TIFF_INTERNAL_MASK {} {} -b 1 -b 2 -b 3 -mask 4", config, options),
                        folder / "in.raw", folder / "in.tif"));
  ASSERT_TRUE(add_overviews("-r nearest", folder / "in.tif", "2"));
  EXPECT_EQ(fs::exists(folder / "in.tif.msk"), std::string_view(config) == "NO");
  auto source = opened(folder / "in.tif");
  ASSERT_TRUE(source);
  EXPECT_FALSE(source->info().opaque);
  const std::size_t levels = source->info().levels.size();
  ASSERT_EQ(levels, 2U);
  for (std::size_t level = 0; level < levels; ++level) {
    ASSERT_TRUE(translate(level + 1 < levels ? "-oo OVERVIEW_LEVEL=0 -b mask -of ENVI" : "-b mask -of ENVI",
                          folder / "in.tif", folder / "mask.raw"));
    const Image got = whole_picture(*source, level);
    std::ifstream mask(folder / "mask.raw", std::ios::binary);
    for (int y = 0; y < got.height_px; ++y) {
      for (int x = 0; x < got.width_px; ++x) ASSERT_EQ(int{pixel_of(got, x, y)[3]}, mask.get()) << x << " " << y;
    }
  }
  auto heights = open_raster(folder / "in.tif", some_place(), {.heights = true});
  EXPECT_FALSE(heights);
}

INSTANTIATE_TEST_SUITE_P(Kinds, Masks,
                         testing::Values(std::pair{"YES", "-co TILED=YES -co BLOCKXSIZE=64 -co BLOCKYSIZE=32"},
                                         std::pair{"YES", "-co COMPRESS=DEFLATE"}, std::pair{"NO", "-co TILED=YES"},
                                         std::pair{"YES", "-co TILED=YES -co COMPRESS=JPEG -co PHOTOMETRIC=YCBCR"}));

TEST(TiffDetailsTest, NumbersUnderAMaskAreUnknown) {
  const ScratchFolder folder;
  write_raw(folder / "in.raw", "Int16", kWidth, kHeight, 2,
            [](int x, int y, int band) { return band == 1 ? (is_clear(x, y) ? 0.0 : 255.0) : gray(x, y, 0) - 100.0; });
  ASSERT_TRUE(translate("--config GDAL_TIFF_INTERNAL_MASK YES -co TILED=YES -b 1 -mask 2", folder / "in.raw",
                        folder / "in.tif"));
  auto source = opened(folder / "in.tif", {.heights = true});
  ASSERT_TRUE(source);
  const Numbers got = whole_numbers(*source, 0);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const float value = got.values[static_cast<std::size_t>(y * kWidth + x)];
      ASSERT_EQ(std::isnan(value), is_clear(x, y)) << x << " " << y;
      if (is_clear(x, y)) continue;
      ASSERT_EQ(value, gray(x, y, 0) - 100.0);
    }
  }
}

TEST(TiffDetailsTest, NodataIsTransparentInPicturesAndUnknownInNumbers) {
  const ScratchFolder folder;
  const auto value = [](int x, int y, int) {
    return is_clear(x, y) ? 7.0 : 8.0 + std::floor(200.0 * noise_at(x, y, 0));
  };
  write_raw(folder / "in.raw", "Byte", kWidth, kHeight, 3, value);
  for (const char* options : {"-co TILED=YES", "-co COMPRESS=LZW", "-co TILED=YES -co INTERLEAVE=BAND"}) {
    ASSERT_TRUE(translate(fmt::format("-a_nodata 7 {}", options), folder / "in.raw", folder / "in.tif"));
    auto source = opened(folder / "in.tif");
    ASSERT_TRUE(source);
    EXPECT_FALSE(source->info().opaque);
    const Image got = whole_picture(*source, 0);
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) ASSERT_EQ(pixel_of(got, x, y)[3], is_clear(x, y) ? 0 : 255);
    }
  }
  for (const char* type : {"Byte", "Int16", "Float32", "Float64"}) {
    ASSERT_TRUE(
        translate(fmt::format("-a_nodata 7 -b 1 -ot {} {}", type, kTiles), folder / "in.raw", folder / "h.tif"));
    auto source = opened(folder / "h.tif", {.heights = true});
    ASSERT_TRUE(source);
    const Numbers got = whole_numbers(*source, 0);
    for (int i = 0; i < kWidth * kHeight; ++i) {
      ASSERT_EQ(std::isnan(got.values[static_cast<std::size_t>(i)]), is_clear(i % kWidth, i / kWidth)) << type;
    }
  }
}

/// GDAL writes the no-data value of a float with more digits than the float has.
TEST(TiffDetailsTest, NodataOfFloatsIsFoundThoughItsTextIsLonger) {
  const ScratchFolder folder;
  write_raw(folder / "in.raw", "Float32", kWidth, kHeight, 1,
            [](int x, int y, int) { return is_clear(x, y) ? -3.4028234663852886e+38 : noise_at(x, y, 0); });
  ASSERT_TRUE(translate("-a_nodata -3.4028234663852886e+38", folder / "in.raw", folder / "in.tif"));
  auto source = opened(folder / "in.tif", {.heights = true});
  ASSERT_TRUE(source);
  const Numbers got = whole_numbers(*source, 0);
  for (int i = 0; i < kWidth * kHeight; ++i) {
    ASSERT_EQ(std::isnan(got.values[static_cast<std::size_t>(i)]), is_clear(i % kWidth, i / kWidth));
  }
}

TEST(TiffDetailsTest, ScaleAndOffsetOfTheMetadataAreApplied) {
  const ScratchFolder folder;
  write_raw(folder / "in.raw", "Int16", kWidth, kHeight, 1, gray);
  ASSERT_TRUE(translate("-a_scale 0.25 -a_offset -1000", folder / "in.raw", folder / "in.tif"));
  auto source = opened(folder / "in.tif", {.heights = true});
  ASSERT_TRUE(source);
  EXPECT_EQ(whole_numbers(*source, 0).values[0], 0.25 * gray(0, 0, 0) - 1000.0);
  auto given = opened(folder / "in.tif", {.heights = true, .scale = 2.0, .offset = 5.0});
  ASSERT_TRUE(given);
  EXPECT_EQ(whole_numbers(*given, 0).values[0], 2.0 * gray(0, 0, 0) + 5.0);
  const RasterFacts facts = facts_of(folder / "in.tif");
  EXPECT_EQ(facts.scale, 0.25);
  EXPECT_EQ(facts.samples, "16-bit signed integers");
}

TEST(TiffDetailsTest, PalettesBitsAndWhiteAsZero) {
  const ScratchFolder folder;
  for (const int bits : {1, 2, 4, 8}) {
    const int most = (1 << bits) - 1;
    write_raw(folder / "in.raw", "Byte", kWidth, kHeight, 1,
              [most](int x, int y, int) { return std::floor((most + 1) * noise_at(x, y, 0)); });
    for (const char* layout : {kTiles, "-co COMPRESS=DEFLATE "}) {
      for (const bool white : {false, true}) {
        ASSERT_TRUE(
            translate(fmt::format("{} -co NBITS={} {}", layout, bits, white ? "-co PHOTOMETRIC=MINISWHITE" : ""),
                      folder / "in.raw", folder / "in.tif"));
        auto source = opened(folder / "in.tif");
        ASSERT_TRUE(source);
        const Image got = whole_picture(*source, 0);
        for (int y = 0; y < kHeight; ++y) {
          for (int x = 0; x < kWidth; ++x) {
            const double value = std::floor((most + 1) * noise_at(x, y, 0));
            const double level = std::round(255.0 * value / most);
            ASSERT_EQ(pixel_of(got, x, y)[1], white ? 255.0 - level : level) << bits;
          }
        }
      }
    }
  }
}

TEST(TiffDetailsTest, PaletteGivesItsColours) {
  const ScratchFolder folder;
  write_raw(folder / "in.raw", "Byte", kWidth, kHeight, 1, [](int x, int y, int) { return (x + y) % 3; });
  std::ofstream(folder / "in.vrt") << fmt::format(
      R"(<VRTDataset rasterXSize="{}" rasterYSize="{}"><VRTRasterBand dataType="Byte" band="1">
<ColorInterp>Palette</ColorInterp><ColorTable><Entry c1="10" c2="20" c3="30"/><Entry c1="200" c2="0" c3="1"/>
<Entry c1="0" c2="255" c3="128"/></ColorTable><SimpleSource><SourceFilename>{}</SourceFilename></SimpleSource>
</VRTRasterBand></VRTDataset>)",
      kWidth, kHeight, (folder / "in.raw").string());
  constexpr int kColours[3][3] = {{10, 20, 30}, {200, 0, 1}, {0, 255, 128}};
  for (const char* options : {"-co TILED=YES", "-co COMPRESS=LZW"}) {
    ASSERT_TRUE(translate(options, folder / "in.vrt", folder / "in.tif"));
    auto source = opened(folder / "in.tif");
    ASSERT_TRUE(source);
    const Image got = whole_picture(*source, 0);
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        for (int c = 0; c < 3; ++c) ASSERT_EQ(pixel_of(got, x, y)[c], kColours[(x + y) % 3][c]);
      }
    }
  }
}

TEST(TiffDetailsTest, PremultipliedAlphaIsDividedOut) {
  const ScratchFolder folder;
  write_raw(folder / "in.raw", "Byte", kWidth, kHeight, 4,
            [](int x, int, int band) { return band == 3 ? x + 100.0 : std::floor((x + 100.0) / 2.0); });
  ASSERT_TRUE(
      translate("-co TILED=YES -co ALPHA=PREMULTIPLIED -co PHOTOMETRIC=RGB", folder / "in.raw", folder / "in.tif"));
  auto source = opened(folder / "in.tif");
  ASSERT_TRUE(source);
  const Image got = whole_picture(*source, 0);
  for (int x = 0; x < kWidth; ++x) {
    ASSERT_NEAR(pixel_of(got, x, 5)[0], 127.5, 1.5) << x;  // half of the alpha, rounded down
    ASSERT_EQ(pixel_of(got, x, 5)[3], x + 100);
  }
}

/// An overview covers what the picture covers, although its sides are rounded up.
TEST(TiffDetailsTest, OverviewsCoverTheSameArea) {
  const ScratchFolder folder;
  write_raw(folder / "in.raw", "Byte", 301, 173, 1, gray);
  ASSERT_TRUE(translate(kTiles, folder / "in.raw", folder / "in.tif"));
  ASSERT_TRUE(add_overviews("-r average", folder / "in.tif", "2 4 8"));
  auto source = opened(folder / "in.tif");
  ASSERT_TRUE(source);
  const auto& levels = source->info().levels;
  ASSERT_EQ(levels.size(), 4U);
  for (const RasterLevel& level : levels) {
    const CrsPoint corner = level.to_crs.at(static_cast<double>(level.width_px), static_cast<double>(level.height_px));
    EXPECT_NEAR(corner.x, 10.0 + 3.01, 1e-12);
    EXPECT_NEAR(corner.y, 50.0 - 1.73, 1e-12);
  }
  EXPECT_LT(levels[0].width_px, levels[3].width_px);
  const RasterFacts facts = facts_of(folder / "in.tif");
  EXPECT_EQ(facts.overviews.size(), 3U);
  EXPECT_EQ(facts.overviews[0], (std::pair<std::int64_t, std::int64_t>{151, 87}));
  EXPECT_EQ(facts.layout, "gray, tiles of 64x64, not compressed");
}

TEST(TiffDetailsTest, BlocksOutsideAreAbsent) {
  const ScratchFolder folder;
  write_raw(folder / "in.raw", "Byte", kWidth, kHeight, 1, gray);
  ASSERT_TRUE(translate(kTiles, folder / "in.raw", folder / "in.tif"));
  auto source = opened(folder / "in.tif");
  ASSERT_TRUE(source);
  for (const TileId& id : {TileId{.level = -1}, TileId{.level = 1}, TileId{.x = -1}, TileId{.x = 3}, TileId{.y = 2}}) {
    const auto tile = source->read(id);
    ASSERT_FALSE(tile);
    EXPECT_EQ(tile.error().kind, MissingKind::absent);
  }
}

}  // namespace
}  // namespace terrella::test
