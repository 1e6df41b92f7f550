#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "raster_files.h"

namespace terrella::test {
namespace {

// Odd sides, so that blocks reach beyond the edges and overviews do not divide evenly.
constexpr int kWide = 301;
constexpr int kHigh = 173;

struct NumberType {
  const char* name;
  double least, most;
  friend void PrintTo(const NumberType& one, std::ostream* out) { *out << one.name; }
};
constexpr NumberType kTypes[] = {
    {"Byte", 0, 255},     {"UInt16", 0, 65535},       {"Int16", -32768, 32767}, {"UInt32", 0, 16777215},
    {"Int32", -8e6, 8e6}, {"Float32", -1.5e4, 9.5e3}, {"Float64", -1e4, 1e4},
};

struct Layout {
  const char* name;
  const char* options;
  friend void PrintTo(const Layout& one, std::ostream* out) { *out << one.name; }
};
constexpr Layout kLayouts[] = {
    {"strips", ""},
    {"one_strip", "-co BLOCKYSIZE=1000"},
    {"deflate_strips", "-co COMPRESS=DEFLATE -co PREDICTOR=2"},
    {"tiles", "-co TILED=YES -co BLOCKXSIZE=64 -co BLOCKYSIZE=32"},
    {"deflate_tiles", "-co TILED=YES -co BLOCKXSIZE=128 -co BLOCKYSIZE=128 -co COMPRESS=DEFLATE"},
    {"lzw_predicted_tiles", "-co TILED=YES -co COMPRESS=LZW -co PREDICTOR=2"},
    {"zstd_tiles", "-co TILED=YES -co COMPRESS=ZSTD"},
    {"lerc_tiles", "-co TILED=YES -co COMPRESS=LERC"},
    {"lerc_zstd_tiles", "-co TILED=YES -co COMPRESS=LERC_ZSTD"},
    {"packbits_strips", "-co COMPRESS=PACKBITS"},
    {"big_endian_tiles", "-co TILED=YES -co ENDIANNESS=BIG"},
    {"bigtiff_tiles", "-co TILED=YES -co BIGTIFF=YES"},
    {"sparse_tiles", "-co TILED=YES -co SPARSE_OK=TRUE"},
};

class NumberMatrix : public testing::TestWithParam<std::tuple<NumberType, Layout>> {};

/// Numbers of every type come out as GDAL reads them, at all levels.
TEST_P(NumberMatrix, EqualsGdal) {
  const NumberType& type = std::get<0>(GetParam());
  const Layout& layout = std::get<1>(GetParam());
  const ScratchFolder folder;
  write_raw(folder / "in.raw", type.name, kWide, kHigh, 1, [&](int x, int y, int band) {
    const double value = type.least + noise_at(x, y, band) * (type.most - type.least);
    return type.name[0] == 'F' ? value : std::floor(value);
  });
  ASSERT_TRUE(translate(layout.options, folder / "in.raw", folder / "in.tif"));
  const bool inside = std::string_view(layout.name).find("strips") == std::string_view::npos;
  ASSERT_TRUE(add_overviews(inside ? "-r nearest" : "-ro -r nearest", folder / "in.tif", "2 4"));
  const auto source = open_raster(folder / "in.tif", some_place(), {.heights = true});
  ASSERT_TRUE(source) << source.error().message;
  ASSERT_EQ((*source)->info().levels.size(), 3U);
  for (int level = 0; level < 3; ++level) {
    const GdalPixels expected = read_by_gdal(folder / "in.tif", 1, 1 - level);
    const Numbers got = whole_numbers(**source, static_cast<std::size_t>(level));
    ASSERT_EQ(got.width_px, expected.width);
    ASSERT_EQ(got.height_px, expected.height);
    for (std::size_t i = 0; i < got.values.size(); ++i) {
      ASSERT_EQ(got.values[i], static_cast<float>(expected.values[i])) << "level " << level << " pixel " << i;
    }
  }
}

// GDAL decodes each layout and each type for all callers: every one is tried, not every pair.
const auto kNameOfPair = [](const auto& test) {
  return fmt::format("{}_{}", std::get<0>(test.param).name, std::get<1>(test.param).name);
};
INSTANTIATE_TEST_SUITE_P(Types, NumberMatrix, testing::Combine(testing::ValuesIn(kTypes), testing::Values(kLayouts[4])),
                         kNameOfPair);
INSTANTIATE_TEST_SUITE_P(Layouts, NumberMatrix,
                         testing::Combine(testing::Values(kTypes[2], kTypes[5]), testing::ValuesIn(kLayouts)),
                         kNameOfPair);

struct PictureCase {
  const char* name;
  int bands;
  const char* options;
  friend void PrintTo(const PictureCase& one, std::ostream* out) { *out << one.name; }
};

class PictureMatrix : public testing::TestWithParam<PictureCase> {};

/// Colours come out as GDAL reads them. The last of two or four bands is alpha.
TEST_P(PictureMatrix, EqualsGdal) {
  const PictureCase& test = GetParam();
  const ScratchFolder folder;
  write_raw(folder / "in.raw", "Byte", kWide, kHigh, test.bands,
            [](int x, int y, int band) { return std::floor(256.0 * noise_at(x / 3, y / 2, band)); });
  ASSERT_TRUE(translate(test.options, folder / "in.raw", folder / "in.tif"));
  ASSERT_TRUE(add_overviews("-r average", folder / "in.tif", "2 4"));
  const auto source = open_raster(folder / "in.tif", some_place(), {});
  ASSERT_TRUE(source) << source.error().message;
  const bool has_alpha = test.bands % 2 == 0;
  EXPECT_EQ((*source)->info().opaque, !has_alpha);
  ASSERT_EQ((*source)->info().levels.size(), 3U);
  for (int level = 0; level < 3; ++level) {
    const GdalPixels expected = read_by_gdal(folder / "in.tif", test.bands, 1 - level);
    const Image got = whole_picture(**source, static_cast<std::size_t>(level));
    ASSERT_EQ(got.width_px, expected.width);
    ASSERT_EQ(got.height_px, expected.height);
    for (int y = 0; y < got.height_px; ++y) {
      for (int x = 0; x < got.width_px; ++x) {
        const std::uint8_t* pixel = got.rgba.data() + (y * got.width_px + x) * 4;
        for (int c = 0; c < 3; ++c) {
          ASSERT_EQ(pixel[c], expected.at(x, y, test.bands < 3 ? 0 : c)) << level << " " << x << " " << y << " " << c;
        }
        ASSERT_EQ(pixel[3], has_alpha ? expected.at(x, y, test.bands - 1) : 255.0);
      }
    }
  }
}

constexpr const char* kTiled = "-co TILED=YES -co BLOCKXSIZE=64 -co BLOCKYSIZE=64";

INSTANTIATE_TEST_SUITE_P(
    Layouts, PictureMatrix,
    testing::Values(PictureCase{"rgb_pixel_tiles", 3, kTiled}, PictureCase{"rgb_strips", 3, ""},
                    PictureCase{"rgb_band_tiles", 3, "-co TILED=YES -co INTERLEAVE=BAND -co COMPRESS=DEFLATE"},
                    PictureCase{"rgb_band_strips", 3, "-co INTERLEAVE=BAND -co COMPRESS=LZW"},
                    PictureCase{"rgba_tiles", 4, "-co TILED=YES -co ALPHA=YES -co COMPRESS=ZSTD"},
                    PictureCase{"rgba_band_tiles", 4, "-co TILED=YES -co ALPHA=YES -co INTERLEAVE=BAND"},
                    PictureCase{"rgba_strips", 4, "-co ALPHA=YES -co COMPRESS=DEFLATE -co PREDICTOR=2"},
                    PictureCase{"gray_alpha", 2, "-co TILED=YES -co ALPHA=YES"},
                    PictureCase{"gray_jpeg", 1, "-co TILED=YES -co COMPRESS=JPEG"},
                    PictureCase{"rgb_jpeg", 3, "-co TILED=YES -co COMPRESS=JPEG -co PHOTOMETRIC=RGB"},
                    PictureCase{"ycbcr_jpeg_tiles", 3, "-co TILED=YES -co COMPRESS=JPEG -co PHOTOMETRIC=YCBCR"},
                    PictureCase{"ycbcr_jpeg_strips", 3, "-co COMPRESS=JPEG -co PHOTOMETRIC=YCBCR"},
                    PictureCase{"webp_lossless", 3, "-co TILED=YES -co COMPRESS=WEBP -co WEBP_LOSSLESS=YES"},
                    PictureCase{"webp_alpha", 4, "-co TILED=YES -co COMPRESS=WEBP -co ALPHA=YES"},
                    PictureCase{"lerc_rgb", 3, "-co TILED=YES -co COMPRESS=LERC_DEFLATE"},
                    PictureCase{"cog", 3, "-of COG -co COMPRESS=DEFLATE -co OVERVIEWS=NONE"},
                    PictureCase{"cog_jpeg", 3, "-of COG -co COMPRESS=JPEG -co OVERVIEWS=NONE"}),
    [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace terrella::test
