#include <fmt/format.h>
#include <gtest/gtest.h>
#include <tiffio.h>

#include "picture_files.h"
#include "streaming/cut/input/row_reader.h"
#include "tiff_files.h"

namespace terrella::test {
namespace {

void expect_same(const Result<Image>& got, const Image& expected) {
  ASSERT_TRUE(got) << got.error().message;
  EXPECT_EQ(got->width_px, expected.width_px);
  EXPECT_EQ(got->height_px, expected.height_px);
  EXPECT_EQ(got->rgba, expected.rgba);
}

Image opaque(Image image) {
  for (std::size_t i = 3; i < image.rgba.size(); i += 4) image.rgba[i] = 255;
  return image;
}

TEST(ReadersTest, Png) {
  const ScratchFolder folder;
  const Image picture = noise(37, 23, true);
  write_png(folder / "plain.png", picture);
  expect_same(read_all_rows(folder / "plain.png"), picture);
  write_interlaced_png(folder / "interlaced.png", picture);
  expect_same(read_all_rows(folder / "interlaced.png"), picture);
  write_deep_png(folder / "deep.png", picture);
  expect_same(read_all_rows(folder / "deep.png"), picture);
  EXPECT_TRUE((*open_rows(folder / "plain.png"))->info().has_alpha);
  write_png(folder / "opaque.png", opaque(picture));
  EXPECT_FALSE((*open_rows(folder / "opaque.png"))->info().has_alpha);
}

TEST(ReadersTest, JpegsAreReadAsTheTileDecoderDoes) {
  const ScratchFolder folder;
  const Image picture = noise(61, 35);
  for (const bool progressive : {false, true}) {
    write_jpeg(folder / "in.jpg", picture, progressive);
    const auto expected = decode_image(read_bytes(folder / "in.jpg"));
    ASSERT_TRUE(expected);
    expect_same(read_all_rows(folder / "in.jpg"), *expected);
  }
}

struct TiffCase {
  const char* name;
  TiffKind kind;
  friend void PrintTo(const TiffCase& one, std::ostream* out) { *out << one.name; }
};

class Tiff : public testing::TestWithParam<TiffCase> {};

/// Result that a reader should give for a picture that write_tiff() wrote.
Image as_read(const Image& picture, const TiffKind& kind) {
  return painted(picture.width_px, picture.height_px, [&](int x, int y, int c) {
    const std::uint8_t* pixel = picture.rgba.data() + (y * picture.width_px + x) * 4;
    const int alpha = kind.extra == EXTRASAMPLE_UNASSALPHA || kind.extra == EXTRASAMPLE_ASSOCALPHA ? pixel[3] : 255;
    if (c == 3) return alpha;
    int colour = pixel[0];
    if (kind.photometric == PHOTOMETRIC_RGB) colour = pixel[c];
    if (kind.photometric == PHOTOMETRIC_MINISWHITE) colour = 255 - pixel[0];
    if (kind.photometric == PHOTOMETRIC_PALETTE) colour = std::array{pixel[0] + 0, 255 - pixel[0], pixel[0] / 2}[c];
    if (kind.extra != EXTRASAMPLE_ASSOCALPHA) return colour;
    return alpha == 0 ? 0 : std::min(255, (colour * 255 + alpha / 2) / alpha);
  });
}

TEST_P(Tiff, EveryKindGivesItsPixels) {
  const ScratchFolder folder;
  const Image picture = noise(53, 41, true);
  write_tiff(folder / "in.tif", picture, GetParam().kind);
  expect_same(read_all_rows(folder / "in.tif"), as_read(picture, GetParam().kind));
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, Tiff,
    testing::Values(TiffCase{"strips", {}},
                    TiffCase{"one_strip", {.compression = COMPRESSION_LZW, .rows_per_strip = 1000}},
                    TiffCase{"tiles", {.tile_px = 16}},
                    TiffCase{"deflated_tiles", {.compression = COMPRESSION_ADOBE_DEFLATE, .tile_px = 32}},
                    TiffCase{"big", {.big = true}}, TiffCase{"big_tiles", {.tile_px = 16, .big = true}},
                    TiffCase{"deep", {.bits = 16}}, TiffCase{"deep_tiles", {.bits = 16, .tile_px = 16}},
                    TiffCase{"gray", {.photometric = PHOTOMETRIC_MINISBLACK}},
                    TiffCase{"deep_gray", {.bits = 16, .photometric = PHOTOMETRIC_MINISBLACK}},
                    TiffCase{"white_is_zero", {.photometric = PHOTOMETRIC_MINISWHITE}},
                    TiffCase{"palette", {.photometric = PHOTOMETRIC_PALETTE, .compression = COMPRESSION_PACKBITS}},
                    TiffCase{"alpha", {.extra = EXTRASAMPLE_UNASSALPHA}},
                    TiffCase{"deep_alpha", {.bits = 16, .extra = EXTRASAMPLE_UNASSALPHA}},
                    TiffCase{"premultiplied", {.extra = EXTRASAMPLE_ASSOCALPHA}},
                    TiffCase{"gray_alpha", {.photometric = PHOTOMETRIC_MINISBLACK, .extra = EXTRASAMPLE_UNASSALPHA}},
                    TiffCase{"fourth_of_no_kind", {.extra = EXTRASAMPLE_UNSPECIFIED}}),
    [](const auto& tiff) { return tiff.param.name; });

TEST(ReadersTest, TiffOfJpegs) {
  constexpr int kJpeg =
      40;  // 8-bit levels: what JPEG of libtiff's default quality does to a gentle slope, with a margin
  const ScratchFolder folder;
  const Image picture = painted(64, 32, [](int x, int y, int c) { return c == 3 ? 255 : 40 * c + x + 2 * y; });
  for (const int tile_px : {0, 16}) {
    write_tiff(
        folder / "in.tif", picture,
        {.photometric = PHOTOMETRIC_YCBCR, .compression = COMPRESSION_JPEG, .tile_px = tile_px, .rows_per_strip = 16});
    const auto got = read_all_rows(folder / "in.tif");
    ASSERT_TRUE(got) << got.error().message;
    for (std::size_t i = 0; i < picture.rgba.size(); ++i) ASSERT_NEAR(got->rgba[i], picture.rgba[i], kJpeg) << i;
  }
}

}  // namespace
}  // namespace terrella::test
