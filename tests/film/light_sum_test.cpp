#include "apps/film/light_sum.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <utility>
#include <vector>

namespace terrella {
namespace {

Image picture(int width_px, std::vector<std::uint8_t> rgba) {
  const int height_px = static_cast<int>(rgba.size()) / 4 / width_px;
  return {width_px, height_px, std::move(rgba)};
}

TEST(LightSum, BlackAndWhiteAreHalfTheLight) {
  LightSum sum({1, 1}, 2);
  sum.add(picture(2, {0, 0, 0, 255, 255, 255, 255, 255, 255, 255, 255, 255, 0, 0, 0, 255}));
  // IEC 61966-2-1 codes half of the light as 1.055 · 0.5^(1/2.4) - 0.055 = 0.7354 of 255.
  EXPECT_EQ(sum.mean().rgba, (std::vector<std::uint8_t>{188, 188, 188, 255}));
}

TEST(LightSum, BoxesLieBesideAndBelowEachOther) {
  LightSum sum({2, 2}, 2);
  std::vector<std::uint8_t> rgba;
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 4; ++x)
      rgba.insert(rgba.end(), {std::uint8_t(100 * (x / 2)), std::uint8_t(70 * (y / 2)), 9, 255});
  }
  sum.add(picture(4, rgba));
  EXPECT_EQ(sum.mean().rgba, (std::vector<std::uint8_t>{0, 0, 9, 255, 100, 0, 9, 255, 0, 70, 9, 255, 100, 70, 9, 255}));
}

TEST(LightSum, EqualPicturesAreTheirMean) {
  std::vector<std::uint8_t> rgba;
  for (int level = 0; level < 256; ++level)
    rgba.insert(rgba.end(), {std::uint8_t(level), std::uint8_t(255 - level), 7, 255});
  LightSum sum({16, 16}, 1);
  for (int k = 0; k < 7; ++k) sum.add(picture(16, rgba));
  EXPECT_EQ(sum.mean().rgba, rgba);
}

TEST(LightSum, ColoursCountAsMuchAsTheyAreOpaque) {
  LightSum sum({1, 1}, 1);
  sum.add(picture(1, {255, 0, 0, 0}));  // invisible
  sum.add(picture(1, {0, 90, 0, 255}));
  EXPECT_EQ(sum.mean().rgba, (std::vector<std::uint8_t>{0, 90, 0, 128}));
}

}  // namespace
}  // namespace terrella
