#include <gtest/gtest.h>
#include <png.h>

#include <algorithm>
#include <array>
#include <cstdlib>

#include "codecs/image.h"
#include "codecs/png_codec.h"
#include "streaming_test_support.h"

namespace terrella {
namespace {

using test::bytes_of;
using test::gradient;

/// Quality 95 with half-resolution colour on a smooth picture; a wrong channel order is off by a hundred.
constexpr int kJpegLevels = 8;

int worst_difference(const Image& a, const Image& b) {
  int worst = 0;
  for (std::size_t i = 0; i < a.rgba.size(); ++i) worst = std::max(worst, std::abs(a.rgba[i] - b.rgba[i]));
  return worst;
}

/// A PNG written by libpng's own simplified writer in a given format.
std::vector<std::byte> png_in_format(int width_px, int height_px, png_uint_32 format, const void* pixels,
                                     const void* colormap = nullptr, png_uint_32 colormap_entries = 0) {
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  header.width = static_cast<png_uint_32>(width_px);
  header.height = static_cast<png_uint_32>(height_px);
  header.format = format;
  header.flags = PNG_IMAGE_FLAG_16BIT_sRGB;
  header.colormap_entries = colormap_entries;
  png_alloc_size_t size = 1 << 16;
  std::vector<std::byte> bytes(size);
  EXPECT_NE(png_image_write_to_memory(&header, bytes.data(), &size, 0, pixels, 0, colormap), 0) << header.message;
  bytes.resize(size);
  return bytes;
}

TEST(Sniff, KnowsByTheFirstBytes) {
  EXPECT_EQ(sniff_format(*encode_jpeg(gradient(8, 8), 80)), ImageFormat::jpeg);
  EXPECT_EQ(sniff_format(*encode_png(gradient(8, 8))), ImageFormat::png);
  EXPECT_EQ(sniff_format(bytes_of("GIF89a")), ImageFormat::unknown);
  EXPECT_EQ(sniff_format(bytes_of("\x89PNG")), ImageFormat::unknown);
  EXPECT_EQ(sniff_format({}), ImageFormat::unknown);
}

TEST(Jpeg, ComesBackAlmostTheSame) {
  const Image image = gradient(61, 37);
  const auto bytes = encode_jpeg(image, 95);
  ASSERT_TRUE(bytes) << bytes.error().message;
  const auto back = decode_image(*bytes);
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->width_px, 61);
  EXPECT_EQ(back->height_px, 37);
  EXPECT_LE(worst_difference(image, *back), kJpegLevels);
}

TEST(Png, ComesBackExactly) {
  for (const auto encode : {encode_png, encode_png_quickly}) {
    Image image = gradient(61, 37);
    const auto opaque = encode(image);
    EXPECT_EQ(decode_image(*opaque)->rgba, image.rgba);
    for (std::size_t i = 3; i < image.rgba.size(); i += 4) image.rgba[i] = static_cast<std::uint8_t>(i);
    const auto translucent = encode(image);
    EXPECT_EQ(decode_image(*translucent)->rgba, image.rgba);
    constexpr std::size_t kColorTypeAt = 25;  // in IHDR
    EXPECT_EQ((*opaque)[kColorTypeAt], std::byte{PNG_COLOR_TYPE_RGB});
    EXPECT_EQ((*translucent)[kColorTypeAt], std::byte{PNG_COLOR_TYPE_RGB_ALPHA});
  }
}

TEST(Png, TilesHaveTheBytesOfLibpngsOwnWriter) {
  const Image image = gradient(61, 37);
  std::vector<std::uint8_t> rgb;
  for (std::size_t i = 0; i < image.rgba.size(); ++i) {
    if (i % 4 != 3) rgb.push_back(image.rgba[i]);
  }
  EXPECT_EQ(*encode_png(image), png_in_format(61, 37, PNG_FORMAT_RGB, rgb.data()));
}

TEST(Png, GrayBecomesRgba) {
  const std::array<std::uint8_t, 2> gray{0, 200};
  const auto image = decode_image(png_in_format(2, 1, PNG_FORMAT_GRAY, gray.data()));
  ASSERT_TRUE(image) << image.error().message;
  EXPECT_EQ(image->rgba, (std::vector<std::uint8_t>{0, 0, 0, 255, 200, 200, 200, 255}));
}

TEST(Png, GrayWithAlphaBecomesRgba) {
  const std::array<std::uint8_t, 4> gray_alpha{10, 20, 30, 40};
  const auto image = decode_image(png_in_format(2, 1, PNG_FORMAT_GA, gray_alpha.data()));
  ASSERT_TRUE(image) << image.error().message;
  EXPECT_EQ(image->rgba, (std::vector<std::uint8_t>{10, 10, 10, 20, 30, 30, 30, 40}));
}

TEST(Png, PaletteBecomesRgba) {
  const std::array<std::uint8_t, 8> colormap{1, 2, 3, 255, 40, 50, 60, 128};
  const std::array<std::uint8_t, 2> indices{1, 0};
  const auto image = decode_image(png_in_format(2, 1, PNG_FORMAT_RGBA_COLORMAP, indices.data(), colormap.data(), 2));
  ASSERT_TRUE(image) << image.error().message;
  EXPECT_EQ(image->rgba, (std::vector<std::uint8_t>{40, 50, 60, 128, 1, 2, 3, 255}));
}

TEST(Png, SixteenBitsAreRounded) {
  const std::array<std::uint16_t, 3> rgb{0x80FF, 0x8000, 0xFFFF};  // 128.99, 127.5… and 255 of 255
  const auto image =
      decode_image(png_in_format(1, 1, PNG_FORMAT_LINEAR_RGB_ALPHA & ~PNG_FORMAT_FLAG_ALPHA, rgb.data()));
  ASSERT_TRUE(image) << image.error().message;
  EXPECT_EQ(image->rgba, (std::vector<std::uint8_t>{128, 128, 255, 255}));
}

TEST(Decoder, TruncatedIsAnError) {
  for (const auto& whole : {*encode_jpeg(gradient(64, 64), 85), *encode_png(gradient(64, 64))}) {
    for (const std::size_t missing : {std::size_t{1}, std::size_t{5}, whole.size() / 2, whole.size() - 9}) {
      const std::span<const std::byte> part(whole.data(), whole.size() - missing);
      EXPECT_FALSE(decode_image(part)) << "without the last " << missing << " of " << whole.size() << " bytes";
    }
  }
}

TEST(Decoder, SaysWhatIsWrong) {
  EXPECT_NE(decode_image({}).error().message.find("no bytes"), std::string::npos);
  EXPECT_NE(decode_image(bytes_of("<html>not found</html>")).error().message.find("no JPEG, PNG or WebP picture"),
            std::string::npos);
}

TEST(Decoder, RefusesPicturesOverALimitBeforeTheirPixels) {
  const Image image = gradient(64, 16);
  for (const auto& bytes : {*encode_jpeg(image, 85), *encode_png(image)}) {
    // The header alone is enough for a refusal that names the size.
    const std::span<const std::byte> head(bytes.data(), bytes.size() - 20);
    const auto too_wide = decode_image(head, {.max_side_px = 63, .max_bytes = 1 << 20});
    ASSERT_FALSE(too_wide);
    EXPECT_NE(too_wide.error().message.find("64×16"), std::string::npos) << too_wide.error().message;
    const auto too_large = decode_image(head, {.max_side_px = 64, .max_bytes = 64 * 16 * 4 - 1});
    ASSERT_FALSE(too_large);
    EXPECT_NE(too_large.error().message.find("4096 bytes"), std::string::npos) << too_large.error().message;
    EXPECT_TRUE(decode_image(bytes, {.max_side_px = 64, .max_bytes = 64 * 16 * 4}));
  }
}

}  // namespace
}  // namespace terrella
