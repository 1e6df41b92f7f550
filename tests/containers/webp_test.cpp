#include <gtest/gtest.h>

#include "codecs/image.h"
#include "streaming/sets/tile_check.h"

namespace terrella {
namespace {

Image gradient(int side_px, int alpha) {
  Image image{.width_px = side_px, .height_px = side_px, .rgba = {}};
  for (int i = 0; i < side_px * side_px; ++i) {
    const int x = i % side_px, y = i / side_px;
    for (const int value : {x * 255 / side_px, y * 255 / side_px, 128, alpha}) {
      image.rgba.push_back(static_cast<std::uint8_t>(value));
    }
  }
  return image;
}

TEST(WebpTest, ComesBackWithinTheLossOfItsQuality) {
  for (const int alpha : {255, 100}) {
    const Image image = gradient(64, alpha);
    const auto bytes = encode_webp(image, 95);
    ASSERT_TRUE(bytes);
    EXPECT_EQ(sniff_format(*bytes), ImageFormat::webp);
    EXPECT_EQ(picture_size(*bytes)->width_px, 64);
    const auto back = decode_image(*bytes);
    ASSERT_TRUE(back) << back.error().message;
    for (std::size_t i = 0; i < image.rgba.size(); ++i) {
      // Alpha is lossless; colours of a smooth picture lose a few levels of 255.
      ASSERT_NEAR(back->rgba[i], image.rgba[i], i % 4 == 3 ? 0 : 12) << i;
    }
  }
}

TEST(WebpTest, EveryTruncationIsAnError) {
  const auto bytes = *encode_webp(gradient(32, 255), 80);
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    ASSERT_FALSE(decode_image(std::span(bytes).first(size))) << size;
    ASSERT_FALSE(check_tile(std::span(bytes).first(size), 32)) << size;
  }
  EXPECT_TRUE(check_tile(bytes, 32));
  EXPECT_NE(check_tile(bytes, 64).error().message.find("another size"), std::string::npos);
}

TEST(WebpTest, LimitsComeBeforePixels) {
  const auto bytes = *encode_webp(gradient(32, 255), 80);
  EXPECT_FALSE(decode_image(bytes, {.max_side_px = 31}));
  EXPECT_FALSE(decode_image(bytes, {.max_side_px = 32, .max_bytes = 32 * 32 * 4 - 1}));
  EXPECT_TRUE(decode_image(bytes, {.max_side_px = 32, .max_bytes = 32 * 32 * 4}));
}

}  // namespace
}  // namespace terrella
