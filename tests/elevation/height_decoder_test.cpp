#include "tiles/height_decoder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>

#include "../streaming/streaming_test_support.h"
#include "elevation_files.h"

namespace terrella::test {
namespace {

constexpr int kSide_px = 16;
constexpr TileId kId{.level = 3, .x = 5, .y = 2};

std::vector<std::uint16_t> ramp() {
  std::vector<std::uint16_t> values;
  for (int i = 0; i < kSide_px * kSide_px; ++i) values.push_back(static_cast<std::uint16_t>(i * 257));
  return values;
}

Result<HeightTile, TileFailure> decode(std::vector<std::byte> bytes, const NumberInfo& info, double tile_scale = 1.0,
                                       double tile_offset = 0.0) {
  return decode_heights(kId, {std::move(bytes), tile_scale, tile_offset}, info, kSide_px);
}

void expect_broken(const Result<HeightTile, TileFailure>& tile, const std::string& says) {
  ASSERT_FALSE(tile);
  EXPECT_EQ(tile.error().kind, MissingKind::broken);
  EXPECT_NE(tile.error().why.find(says), std::string::npos) << tile.error().why;
}

TEST(HeightDecoder, NumbersBecomeMetresByTheTileThenTheSet) {
  const auto tile = decode(gray16_png(ramp()), {.scale = 2.0, .offset = -100.0, .nodata = {}}, 0.5, 10.0);
  ASSERT_TRUE(tile) << tile.error().why;
  EXPECT_EQ(tile->id, kId);
  EXPECT_EQ(tile->side_px, kSide_px);
  for (std::size_t i = 0; i < tile->heights_m.size(); ++i) {
    EXPECT_EQ(tile->heights_m[i], static_cast<float>((static_cast<double>(i) * 257.0 * 0.5 + 10.0) * 2.0 - 100.0));
  }
  EXPECT_EQ(tile->min_m, -80.0F);
  EXPECT_EQ(tile->max_m, 65535.0F - 80.0F);
  EXPECT_EQ(tile->unknown, 0U);
}

// The values of Mapbox's and Tilezen's own documentation: Rgb (1, 134, 160) is 0 m, and (128, 0, 0) is 0 m.
TEST(HeightDecoder, ColoursAreTerrainRgbOrTerrarium) {
  Image picture{kSide_px, kSide_px, std::vector<std::uint8_t>(kSide_px * kSide_px * 4, 255)};
  const auto paint = [&picture](int at, std::array<std::uint8_t, 4> colour) {
    std::ranges::copy(colour, picture.rgba.begin() + 4 * at);
  };
  for (int i = 0; i < kSide_px * kSide_px; ++i) paint(i, {1, 134, 160, 255});
  paint(1, {1, 134, 161, 255});
  paint(2, {2, 221, 60, 255});
  paint(3, {9, 9, 9, 0});
  NumberInfo info{.scale = 0.1, .offset = -10000.0};
  info.rgb = true;
  const auto mapbox = decode(*encode_png(picture), info);
  ASSERT_TRUE(mapbox) << mapbox.error().why;
  EXPECT_NEAR(mapbox->heights_m[0], 0.0F, 1e-3);
  EXPECT_NEAR(mapbox->heights_m[1], 0.1F, 1e-3);
  EXPECT_NEAR(mapbox->heights_m[2], 8770.8F, 1e-3);  // 2 · 65536 + 221 · 256 + 60 = 187708
  EXPECT_EQ(mapbox->unknown, 1U);
  for (int i = 0; i < kSide_px * kSide_px; ++i) paint(i, {128, 0, 0, 255});
  paint(1, {162, 145, 128, 255});
  info.scale = 1.0 / 256.0;
  info.offset = -32768.0;
  const auto terrarium = decode(*encode_png(picture), info);
  ASSERT_TRUE(terrarium) << terrarium.error().why;
  EXPECT_EQ(terrarium->heights_m[0], 0.0F);
  EXPECT_EQ(terrarium->heights_m[1], 162.0F * 256.0F + 145.0F + 0.5F - 32768.0F);
  expect_broken(decode(*encode_jpeg(picture, 90), info), "JPEG");
}

TEST(HeightDecoder, NodataBeyondTheNumbersIsNone) {
  for (const double nodata : {-32768.0, 70000.0, 0.5, 1e300}) {
    EXPECT_EQ(decode(gray16_png(ramp()), {.nodata = nodata})->unknown, 0U) << nodata;
  }
  EXPECT_EQ(decode(gray16_png(ramp()), {.nodata = 257.0})->unknown, 1U);
}

TEST(HeightDecoder, FloatsThatAreNoHeightsAreUnknown) {
  std::vector<float> values(kSide_px * kSide_px, 12.5F);
  values[0] = std::numeric_limits<float>::quiet_NaN();
  values[1] = std::numeric_limits<float>::infinity();
  values[2] = -9999.1F;
  values[3] = std::numeric_limits<float>::lowest();
  const auto tile = decode(float_tiff(values), {.nodata = -9999.1, .floats = true});
  expect_broken(tile, "beyond");  // the lowest float is nodata only where it is said to be
  values[3] = 0.0F;
  const auto good = decode(float_tiff(values), {.nodata = -9999.1, .floats = true}, 2.0, 1.0);
  ASSERT_TRUE(good) << good.error().why;
  EXPECT_EQ(good->unknown, 3U);
  EXPECT_EQ(good->heights_m[3], 1.0F);
  EXPECT_EQ(good->max_m, 26.0F);
  EXPECT_EQ(good->min_m, 1.0F);
}

TEST(HeightDecoder, WhatIsUnknownIsNeitherPitNorSpike) {
  // A plateau at 3000 m with a hole of one pixel and nothing known from column 9 on.
  constexpr std::uint16_t kNone = 65535;
  std::vector<std::uint16_t> values(kSide_px * kSide_px, 3000);
  values[5 * kSide_px + 4] = kNone;
  for (int y = 0; y < kSide_px; ++y) {
    for (int x = 9; x < kSide_px; ++x) values[static_cast<std::size_t>(y * kSide_px + x)] = kNone;
  }
  const auto tile = decode(gray16_png(values), {.nodata = double{kNone}});
  ASSERT_TRUE(tile) << tile.error().why;
  EXPECT_EQ(tile->unknown, 7U * kSide_px + 1U);
  EXPECT_EQ(tile->min_m, 0.0F);
  EXPECT_EQ(tile->max_m, 3000.0F);
  EXPECT_GE(tile->heights_m[5 * kSide_px + 4], 2000.0F);
  for (int y = 0; y < kSide_px; ++y) {
    for (int x = 9; x < kSide_px; ++x) {
      const float here = tile->heights_m[static_cast<std::size_t>(y * kSide_px + x)];
      const float before = tile->heights_m[static_cast<std::size_t>(y * kSide_px + x - 1)];
      EXPECT_LE(here, before);
      EXPECT_LE(before - here, 751.0F) << "a quarter of 16 pixels to come down over";
    }
    EXPECT_EQ(tile->heights_m[static_cast<std::size_t>(y * kSide_px + 15)], 0.0F);
  }
}

TEST(HeightDecoder, ATileOfNothingKnownIsLevel) {
  const auto tile = decode(gray16_png(std::vector<std::uint16_t>(kSide_px * kSide_px, 7)),
                           {.scale = 1.0, .offset = 5.0, .nodata = 7.0});
  ASSERT_TRUE(tile) << tile.error().why;
  EXPECT_EQ(tile->min_m, 0.0F);
  EXPECT_EQ(tile->max_m, 0.0F);
}

TEST(HeightDecoder, WhatIsBrokenSaysWhy) {
  const NumberInfo whole;
  const NumberInfo floats{.nodata = {}, .floats = true};
  expect_broken(decode(bytes_of("junk"), whole), "no PNG picture");
  expect_broken(decode({}, whole), "no PNG picture");
  expect_broken(decode(*encode_png(gradient(kSide_px, kSide_px)), whole), "RGB of 8 bits");
  expect_broken(decode(gray16_png(std::vector<std::uint16_t>(64)), whole), "8×8");
  expect_broken(decode(gray16_png(ramp()), {.scale = 1e9, .nodata = {}}), "scale or offset is wrong");
  expect_broken(decode(gray16_png(ramp()), floats), "TIFF");
  expect_broken(decode(float_tiff(std::vector<float>(64)), floats), "8×8");
  auto half = gray16_png(ramp());
  half.resize(half.size() / 2);
  expect_broken(decode(half, whole), "PNG");
}

/// Every prefix, and bits flipped: whatever comes out, it must come out, and be finite.
void feed_damaged(const std::vector<std::byte>& whole, const NumberInfo& info) {
  const auto check = [&info](const std::vector<std::byte>& bytes) {
    const auto tile = decode(bytes, info);
    if (!tile) {
      EXPECT_FALSE(tile.error().why.empty());
      return;
    }
    ASSERT_EQ(tile->heights_m.size(), static_cast<std::size_t>(kSide_px * kSide_px));
    for (const float height_m : tile->heights_m) ASSERT_TRUE(std::isfinite(height_m));
  };
  for (std::size_t size = 0; size < whole.size(); size += 3) {
    check({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)});
  }
  std::mt19937 random(5);
  for (int i = 0; i < 400; ++i) {
    std::vector<std::byte> damaged = whole;
    for (std::uint32_t flips = 1 + random() % 4; flips > 0; --flips) {
      damaged[random() % damaged.size()] ^= static_cast<std::byte>(1U << (random() % 8));
    }
    check(damaged);
  }
}

TEST(HeightDecoder, DamagedBytesNeverCrash) {
  feed_damaged(gray16_png(ramp()), {});
  std::vector<float> values;
  for (const std::uint16_t value : ramp()) values.push_back(static_cast<float>(value) * 0.1F);
  feed_damaged(float_tiff(values), {.nodata = {}, .floats = true});
}

}  // namespace
}  // namespace terrella::test
