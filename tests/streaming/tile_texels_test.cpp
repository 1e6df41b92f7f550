#include "tiles/tile_texels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "streaming_test_support.h"

namespace terrella {
namespace {

Image noise(int side_px, bool opaque = false) {
  Image image{side_px, side_px, {}};
  std::mt19937 random(7);
  image.rgba.resize(static_cast<std::size_t>(side_px) * static_cast<std::size_t>(side_px) * 4);
  for (auto& channel : image.rgba) channel = static_cast<std::uint8_t>(random());
  if (!opaque) return image;
  for (std::size_t i = 3; i < image.rgba.size(); i += 4) image.rgba[i] = 255;
  return image;
}

/// The definition, by one channel of one texel: (x, y) counts from the corner of the interior and may lie in the
/// border.
int expected(const Image& tile, int mip, int x, int y, int channel) {
  const int box = 1 << mip;
  const int side = tile.width_px >> mip;
  const int left = std::clamp(x, 0, side - 1) * box;
  const int top = std::clamp(y, 0, side - 1) * box;
  double sum = 0.0;
  double weights = 0.0;
  for (int row = top; row < top + box; ++row) {
    for (int column = left; column < left + box; ++column) {
      const std::uint8_t* texel = tile.rgba.data() + static_cast<std::size_t>((row * tile.width_px + column) * 4);
      const double weight = channel == 3 ? 1.0 : texel[3];
      sum += weight * texel[channel];
      weights += weight;
    }
  }
  if (mip == 0) return tile.rgba[static_cast<std::size_t>((top * tile.width_px + left) * 4 + channel)];
  return weights == 0.0 ? 0 : static_cast<int>(std::floor(sum / weights + 0.5));
}

void expect_as_defined(const Image& tile, int gutter, int mips) {
  const auto texels = make_texels(tile, tile.width_px, gutter, mips);
  ASSERT_TRUE(texels) << texels.error().why;
  ASSERT_EQ(texels->mips.size(), static_cast<std::size_t>(mips));
  for (int mip = 0; mip < mips; ++mip) {
    const int side = mip_side_px(tile.width_px, gutter, mip);
    const auto& pixels = texels->mips[static_cast<std::size_t>(mip)];
    ASSERT_EQ(pixels.size(), static_cast<std::size_t>(side) * static_cast<std::size_t>(side) * 4);
    int wrong = 0;
    for (int i = 0; i < side * side * 4; ++i) {
      const int border = gutter >> mip;
      const int want = expected(tile, mip, i / 4 % side - border, i / 4 / side - border, i % 4);
      if (pixels[static_cast<std::size_t>(i)] != want) ++wrong;
    }
    EXPECT_EQ(wrong, 0) << "channels of mip " << mip << " with a gutter of " << gutter;
  }
}

TEST(TileTexels, AreTheTileWithABorderAndItsMeans) {
  expect_as_defined(noise(64), 4, 3);
  expect_as_defined(noise(64), 0, 1);
  expect_as_defined(noise(32), 1, 2);
  expect_as_defined(noise(32), 16, kMaxMips);
  expect_as_defined(noise(50), 4, 3);
  expect_as_defined(noise(16), 0, kMaxMips);
  expect_as_defined(noise(64, true), 4, 3);
  expect_as_defined(noise(32, true), 16, kMaxMips);
}

TEST(TileTexels, WhatIsInvisibleDoesNotTintWhatIsNot) {
  Image tile{16, 16, std::vector<std::uint8_t>(16 * 16 * 4, 0)};
  for (std::size_t i = 0; i < tile.rgba.size(); i += 8) {
    for (const std::size_t c : {0, 1, 2}) tile.rgba[i + c] = 200;
    tile.rgba[i + 3] = 255;
  }
  const auto texels = make_texels(tile, 16, 0, 2);
  ASSERT_TRUE(texels);
  EXPECT_EQ(texels->mips[1][0], 200);
  EXPECT_EQ(texels->mips[1][3], 128);  // 127.5, halves up
}

TEST(TileTexels, RoundingDoesNotBuildUp) {
  // Three eighths of the texels are 1: their mean rounds to 0. Boxes of 2×2 have the means 0.5 and 0.25, and halves
  // that were rounded up at every level would grow to 1.
  Image tile{16, 16, std::vector<std::uint8_t>(16 * 16 * 4, 0)};
  for (std::size_t i = 0; i < tile.rgba.size(); ++i) {
    tile.rgba[i] = i % 4 == 3 ? 255 : (i / 4) % 2 == 0 && (i / 64) % 4 < 3 ? 1 : 0;
  }
  const auto texels = make_texels(tile, 16, 0, 4);
  ASSERT_TRUE(texels);
  for (std::size_t i = 0; i < texels->mips[3].size(); ++i) EXPECT_EQ(texels->mips[3][i], i % 4 == 3 ? 255 : 0);
}

TEST(TileTexels, WhiteStaysWhite) {
  const Image tile{16, 16, std::vector<std::uint8_t>(16 * 16 * 4, 255)};
  const auto texels = make_texels(tile, 16, 4, kMaxMips);
  ASSERT_TRUE(texels);
  for (const auto& mip : texels->mips) {
    EXPECT_TRUE(std::all_of(mip.begin(), mip.end(), [](std::uint8_t channel) { return channel == 255; }));
  }
}

TEST(TileTexels, SizeIsTheSumOfTheMips) {
  const auto texels = make_texels(noise(64), 64, 4, 2);
  ASSERT_TRUE(texels);
  EXPECT_EQ(size_bytes(*texels), (72U * 72U + 36U * 36U) * 4U);
}

TEST(TileTexels, ATileOfAnotherSizeIsBroken) {
  const auto texels = make_texels(test::gradient(64, 32), 64, 4, 3);
  ASSERT_FALSE(texels);
  EXPECT_EQ(texels.error().kind, MissingKind::broken);
  EXPECT_NE(texels.error().why.find("64×32"), std::string::npos) << texels.error().why;
  EXPECT_NE(texels.error().why.find("64×64"), std::string::npos) << texels.error().why;
}

}  // namespace
}  // namespace terrella
