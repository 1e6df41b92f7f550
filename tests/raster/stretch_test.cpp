#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "raster_files.h"

namespace terrella::test {
namespace {

constexpr int kSide = 200;

/// The middle pixel of each row, gray, of a picture whose rows rise evenly from `least` to `most`.
std::vector<int> ramp_levels(const std::string& type, double least, double most, const std::string& options,
                             std::vector<std::string>* notes = nullptr) {
  const ScratchFolder folder;
  write_raw(folder / "in.raw", type, kSide, kSide, 1,
            [&](int, int y, int) { return least + (most - least) * y / (kSide - 1.0); });
  EXPECT_TRUE(translate(options, folder / "in.raw", folder / "in.tif"));
  const auto source = open_raster(folder / "in.tif", some_place());
  EXPECT_TRUE(source) << source.error().message;
  const RasterFacts facts = facts_of(folder / "in.tif");
  if (notes != nullptr) *notes = facts.notes;
  const Image image = whole_picture(**source, 0);
  std::vector<int> levels;
  for (int y = 0; y < kSide; ++y) levels.push_back(image.rgba[static_cast<std::size_t>(y * kSide + kSide / 2) * 4]);
  return levels;
}

/// From the 2nd to the 98th percentile of an even ramp, gray rises evenly from black to white.
void expect_even_rise(const std::vector<int>& levels) {
  for (int y = 0; y < kSide; ++y) {
    const double share = std::clamp((y / (kSide - 1.0) - 0.02) / 0.96, 0.0, 1.0);
    EXPECT_NEAR(levels[static_cast<std::size_t>(y)], 255.0 * share, 2.0) << y;
  }
}

TEST(StretchTest, NarrowRangesFillTheGrayLevels) {
  for (const char* options : {"-co TILED=YES", "-co COMPRESS=LZW"}) {
    std::vector<std::string> notes;
    expect_even_rise(ramp_levels("UInt16", 1000, 3520, options, &notes));
    ASSERT_EQ(notes.size(), 1U);
    EXPECT_NE(notes[0].find("2nd to the 98th percentile"), std::string::npos) << notes[0];
    for (const auto& [type, least, most] : {std::tuple{"Int16", -5000.0, 3000.0}, std::tuple{"Float32", -0.5, 0.25},
                                            std::tuple{"Int32", -9e8, 9e8}, std::tuple{"Float64", 1e6, 2e6}}) {
      expect_even_rise(ramp_levels(type, least, most, options));
    }
  }
}

TEST(StretchTest, WideSixteenBitPicturesStayAsTheyAre) {
  std::vector<std::string> notes{"none yet"};
  const auto levels = ramp_levels("UInt16", 0, 65535, "-co TILED=YES", &notes);
  EXPECT_TRUE(notes.empty());
  for (int y = 0; y < kSide; ++y) {
    EXPECT_NEAR(levels[static_cast<std::size_t>(y)], 255.0 * y / (kSide - 1.0), 1.0);
  }
}

TEST(StretchTest, StatisticsOfTheMetadataComeFirst) {
  std::vector<std::string> notes;
  const auto levels = ramp_levels(
      "UInt16", 1000, 3000, "-co TILED=YES -mo IGNORED=1 -co PROFILE=GDALGeoTIFF -stats -co COPY_SRC_MDD=YES", &notes);
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_NE(notes[0].find("metadata"), std::string::npos) << notes[0];
  EXPECT_EQ(levels.front(), 0);
  EXPECT_EQ(levels.back(), 255);
  EXPECT_NEAR(levels[kSide / 2], 128.0, 1.5);
}

TEST(StretchTest, ColoursShareOneRange) {
  const ScratchFolder folder;
  write_raw(folder / "in.raw", "UInt16", kSide, kSide, 3, [](int x, int, int band) { return 1000.0 * (band + 1) + x; });
  ASSERT_TRUE(translate("-co TILED=YES -co PHOTOMETRIC=RGB", folder / "in.raw", folder / "in.tif"));
  const auto source = open_raster(folder / "in.tif", some_place());
  ASSERT_TRUE(source) << source.error().message;
  const Image image = whole_picture(**source, 0);
  // The range is about 1000 to 3200, so that the bands lie at a fraction of 0.05, 0.5 and 0.95 of it.
  EXPECT_NEAR(image.rgba[4 * kSide / 2], 0.045 * 255.0, 8.0);
  EXPECT_NEAR(image.rgba[4 * kSide / 2 + 1], 0.5 * 255.0, 8.0);
  EXPECT_NEAR(image.rgba[4 * kSide / 2 + 2], 0.955 * 255.0, 8.0);
}

TEST(StretchTest, NodataTakesNoPartAndOneValueIsGray) {
  const ScratchFolder folder;
  write_raw(folder / "in.raw", "Float32", kSide, kSide, 1,
            [](int x, int, int) { return x < kSide / 2 ? -9999.0 : 5.0; });
  ASSERT_TRUE(translate("-a_nodata -9999 -co TILED=YES", folder / "in.raw", folder / "in.tif"));
  const auto source = open_raster(folder / "in.tif", some_place());
  ASSERT_TRUE(source) << source.error().message;
  const Image image = whole_picture(**source, 0);
  EXPECT_EQ(image.rgba[3], 0);
  EXPECT_EQ(image.rgba[4 * (kSide - 1)], 128);
  EXPECT_EQ(image.rgba[4 * (kSide - 1) + 3], 255);
}

}  // namespace
}  // namespace terrella::test
