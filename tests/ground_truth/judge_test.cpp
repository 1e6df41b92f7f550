#include "apps/bench/truth/judge.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "apps/bench/truth/noise_planet.h"
#include "apps/bench/truth/tile_border_mask.h"
#include "apps/bench/truth/truth_cache.h"

namespace terrella::truth {
namespace {

constexpr double kRounding_rms = 0.2887;  // 1/sqrt(12): what rounding to whole levels leaves
constexpr double kStatistics_rms = 0.01;  // some ten thousand samples
const TruthCamera kCamera{.eye = {0, 180, 19e6}};
constexpr TruthOptions kOptions{.width = 128, .height = 128, .rays_per_side = 4};

const TruthImage& truth() {
  static const TruthImage image = cast(noise_planet({.width = 256, .height = 128}), {}, Spheroid{}, kCamera, kOptions);
  return image;
}

Picture rounded_truth() {
  Picture shot{128, 128, {}};
  for (const float level : truth().rgb) shot.rgb.push_back(static_cast<std::uint8_t>(std::lround(level)));
  return shot;
}

std::size_t pixel(int x, int y) { return static_cast<std::size_t>(128 * y + x); }

Judgement judged(const Picture& shot) { return judge(shot, truth(), Spheroid{}, {}, TileBorders{180, 2}); }

TEST(JudgeTest, TheRoundedTruthHasNothingButRounding) {
  const Judgement judgement = judged(rounded_truth());
  EXPECT_NEAR(judgement[Zone::all].rms, kRounding_rms, kStatistics_rms);
  EXPECT_LE(judgement[Zone::all].max, 0.5);
  EXPECT_EQ(judgement.limb.off, 0U);
  EXPECT_GT(judgement.limb.pixels, 200U);
  EXPECT_GT(judgement.outside.pixels, judgement.limb.pixels);
  EXPECT_EQ(judgement.outside.pixels + judgement[Zone::all].pixels, 128U * 128U);
}

TEST(JudgeTest, ZonesAreWhereTheirNamesSay) {
  const Judgement judgement = judged(rounded_truth());
  EXPECT_EQ(judgement[Zone::pole].pixels, 0U) << "from over the equator at 4 radii the limb is at 75.5°";
  EXPECT_GT(judgement[Zone::antimeridian].pixels, 100U);
  EXPECT_GT(judgement[Zone::antimeridian_surroundings].pixels, judgement[Zone::antimeridian].pixels);
  EXPECT_LT(judgement[Zone::clear].pixels, judgement[Zone::all].pixels);
  EXPECT_LT(judgement[Zone::facing].pixels, judgement[Zone::mid_latitudes].pixels);
  EXPECT_GT(judgement[Zone::tile_borders].pixels, 100U);
}

TEST(JudgeTest, TheCoreIsADiscAroundAVisiblePole) {
  constexpr std::size_t kDisc_px = 5025;  // lattice points within 40 of the middle
  const auto core_from = [](const TruthCamera& camera) {
    const TruthImage image = cast(noise_planet({.width = 256, .height = 128}), {}, Spheroid{}, camera, kOptions);
    return judge({128, 128, std::vector<std::uint8_t>(3 * 128 * 128)}, image, Spheroid{}, {}, {})[Zone::pole_core];
  };
  EXPECT_EQ(core_from({.eye = {90, 0, 6e6}}).pixels, kDisc_px);
  EXPECT_EQ(core_from({.eye = {-88, 30, 2e6}}).pixels, kDisc_px);
  EXPECT_EQ(core_from({.eye = {60, 0, 1e6}}).pixels, 0U) << "the pole is beyond the picture";
  EXPECT_EQ(core_from(kCamera).pixels, 0U) << "the poles are beyond the limb";
}

TEST(JudgeTest, AnErrorCountsInItsZonesOnly) {
  Picture shot = rounded_truth();
  const Judgement before = judged(shot);
  const std::size_t centre = pixel(64, 64);
  for (std::size_t c = 3 * centre; c < 3 * centre + 3; ++c) shot.rgb[c] = static_cast<std::uint8_t>(shot.rgb[c] ^ 0x80);
  const Judgement after = judged(shot);
  EXPECT_NEAR(after[Zone::antimeridian].max, 128.0, 0.5);
  EXPECT_GT(after[Zone::tile_borders].rms, before[Zone::tile_borders].rms);
  EXPECT_EQ(after[Zone::antimeridian_surroundings].rms, before[Zone::antimeridian_surroundings].rms);
}

TEST(JudgeTest, SurroundingsAreWeighedLikeTheZone) {
  // An error that grows with incidence alone: the border zone and its surroundings differ in their pixels' incidence,
  // but the figures that are compared agree to what a cell of 10° leaves.
  Picture shot{128, 128, std::vector<std::uint8_t>(3 * 128 * 128)};
  TruthImage image = truth();
  for (std::size_t i = 0; i < image.hits.size(); ++i) {
    const float incidence = std::isnan(image.incidence_deg[i]) ? 0.0F : image.incidence_deg[i];
    for (std::size_t c = 3 * i; c < 3 * i + 3; ++c) image.rgb[c] = incidence;
  }
  const Judgement judgement = judge(shot, image, Spheroid{}, {}, TileBorders{15, 0});
  constexpr double kWithinCells = 0.03;
  EXPECT_NEAR(judgement[Zone::tile_borders].rms / judgement[Zone::border_surroundings].rms, 1.0, kWithinCells);
}

TEST(JudgeTest, ABrightPixelBesideTheDiscCountsAtTheLimb) {
  Picture shot = rounded_truth();
  int x = 0;
  while (truth().hits[pixel(x + 1, 64)] == 0) ++x;
  shot.rgb[3 * pixel(x, 64)] = 41;
  shot.rgb[3 * pixel(0, 0)] = 41;
  const Judgement judgement = judged(shot);
  EXPECT_EQ(judgement.limb.off, 1U);
  EXPECT_EQ(judgement.outside.off, 2U);
}

TEST(JudgeTest, AnotherSizeIsRefused) { EXPECT_THROW((void)judged(Picture{1, 1, {0, 0, 0}}), std::invalid_argument); }

TEST(TileBorderMaskTest, IsAtMostTwoPixelsWideAndOnTheGridsLines) {
  const Mask mask = tile_border_mask(truth(), Spheroid{}, {}, {180, 1});
  EXPECT_TRUE(mask.set[pixel(63, 50)]);
  EXPECT_TRUE(mask.set[pixel(64, 50)]) << "the antimeridian, between the two middle columns";
  EXPECT_FALSE(mask.set[pixel(62, 50)]);
  EXPECT_FALSE(mask.set[pixel(65, 50)]);
  EXPECT_TRUE(mask.set[pixel(70, 63)]) << "the equator";
  EXPECT_FALSE(mask.set[pixel(0, 64)]) << "the sky";
}

TEST(TileBorderMaskTest, GrowsIntoASquare) {
  Mask mask{7, 5, std::vector<std::uint8_t>(35)};
  mask.set[2 * 7 + 3] = 1;
  const Mask more = grown(mask, 1);
  EXPECT_EQ(std::count(more.set.begin(), more.set.end(), 1), 9);
  EXPECT_TRUE(more.set[1 * 7 + 2]);
}

TEST(TruthCacheTest, AnswersFromTheFileAndSurvivesADamagedOne) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "terrella_truth_cache_test";
  std::filesystem::remove_all(folder);
  const Source source = make_source(noise_planet({.width = 256, .height = 128}));
  const auto ask = [&] { return cast_cached(source, {}, Spheroid{}, kCamera, kOptions, folder); };
  EXPECT_EQ(ask().rgb, truth().rgb);
  EXPECT_EQ(ask().hits, truth().hits);
  ASSERT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 1);
  std::filesystem::resize_file(std::filesystem::directory_iterator(folder)->path(), 1000);
  EXPECT_EQ(ask().rgb, truth().rgb);
  std::filesystem::remove_all(folder);
}

TEST(PictureTest, PngGoesThereAndBack) {
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "terrella_picture_test.png";
  const Picture picture = rounded_truth();
  write_png(picture, file);
  EXPECT_EQ(read_picture(file).rgb, picture.rgb);
  std::filesystem::remove(file);
}

TEST(PictureTest, WhatIsNoPictureIsNamed) {
  EXPECT_THROW((void)read_picture("/nowhere/at/all.png"), std::runtime_error);
}

}  // namespace
}  // namespace terrella::truth
