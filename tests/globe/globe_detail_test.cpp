// Pictures have the detail and the accuracy that GlobeOptions ask for.
#include <cmath>
#include <limits>

#include "globe/experiments.h"
#include "tests/gl/gl_fixture.h"

namespace terrella::test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

std::shared_ptr<TileSource> deep_tiles() { return one_colour({.tile_px = 64, .max_level = 9}, {190, 120, 60}); }

Camera over_the_alps() { return {.eye = {.lat = Angle::degrees(46.0), .lon = Angle::degrees(7.0), .height_m = 2.0e6}}; }

class GlobeDetail : public GlTest {
 protected:
  static std::string complaint(const GlobeOptions& options) {
    const auto globe = Globe::create(options, deep_tiles());
    return globe ? std::string() : globe.error().message;
  }
  FrameStats settled(const GlobeOptions& options, CubeMapping mapping = CubeMapping::tangent) {
    const auto globe = Globe::create(options);
    EXPECT_TRUE(globe);
    Experiments::of(**globe).mapping = mapping;
    EXPECT_TRUE((*globe)->add_imagery(deep_tiles()));
    (*globe)->set_camera(over_the_alps());
    return settle(**globe, {256, 256});
  }
  int background() const {
    int count = 0;
    const Picture shown = picture();
    for (int y = 0; y < shown.size.height_px; ++y) {
      for (int x = 0; x < shown.size.width_px; ++x) count += shown.at(x, y) == Color{} ? 1 : 0;
    }
    return count;
  }
};

TEST_F(GlobeDetail, TheEndsOfEveryRangeAreTaken) {
  for (const double texels : {0.125, 8.0}) {
    GlobeOptions options;
    options.texels_per_pixel = texels;
    EXPECT_EQ(complaint(options), "");
  }
  for (const double error_px : {0.01, 16.0}) {
    GlobeOptions options;
    options.max_error_px = error_px;
    EXPECT_EQ(complaint(options), "");
  }
  for (const int segments : {2, 128}) {
    GlobeOptions options;
    options.segments = segments;
    EXPECT_EQ(complaint(options), "");
  }
  for (const int gutter : {0, 64}) {
    GlobeOptions options;
    options.gutter_px = gutter;
    EXPECT_EQ(complaint(options), "");
  }
}

TEST_F(GlobeDetail, WhatIsOutsideItsRangeIsNamed) {
  for (const double texels : {0.1, 8.5, -1.0, kNan}) {
    GlobeOptions options;
    options.texels_per_pixel = texels;
    EXPECT_NE(complaint(options).find("texels_per_pixel"), std::string::npos) << texels;
  }
  for (const double error_px : {0.0, 17.0, kNan}) {
    GlobeOptions options;
    options.max_error_px = error_px;
    EXPECT_NE(complaint(options).find("max_error_px"), std::string::npos) << error_px;
  }
  for (const int segments : {0, 23, 130}) {
    GlobeOptions options;
    options.segments = segments;
    EXPECT_NE(complaint(options).find("segments"), std::string::npos) << segments;
  }
  for (const int gutter : {-1, 65}) {
    GlobeOptions options;
    options.gutter_px = gutter;
    EXPECT_NE(complaint(options).find("gutter_px"), std::string::npos) << gutter;
  }
}

// Twice the texels a pixel are the next level: four times the tiles, less what hangs over the picture's edge.
TEST_F(GlobeDetail, TwiceTheTexelsAPixelAreTheNextLevel) {
  std::vector<double> tiles;
  for (const double texels : {0.5, 1.0, 2.0}) {
    GlobeOptions options = unlit_options();
    options.texels_per_pixel = texels;
    tiles.push_back(settled(options).tiles_wanted);
  }
  for (std::size_t k = 1; k < tiles.size(); ++k) {
    EXPECT_GT(tiles[k] / tiles[k - 1], 2.5) << k;
    EXPECT_LT(tiles[k] / tiles[k - 1], 4.5) << k;
  }
}

// A quad's error goes with the square of its side, and patches are split in four: a sixteenth of the error takes
// sixteen times the triangles, less those beyond the picture's edge, whole patches in both.
TEST_F(GlobeDetail, ASixteenthOfTheErrorTakesManyTimesTheTriangles) {
  GlobeOptions coarse = unlit_options(), fine = unlit_options();
  coarse.segments = fine.segments = 8;
  coarse.max_error_px = 0.32;
  fine.max_error_px = 0.02;
  const auto ratio = static_cast<double>(settled(fine).triangles) / static_cast<double>(settled(coarse).triangles);
  EXPECT_GT(ratio, 4.0);
  EXPECT_LT(ratio, 25.0);
}

TEST_F(GlobeDetail, NoHolesAtTheEndsOfTheRangesInEitherMapping) {
  for (const CubeMapping mapping : {CubeMapping::plain, CubeMapping::tangent}) {
    for (const int segments : {2, 128}) {
      GlobeOptions options = unlit_options();
      options.segments = segments;
      options.gutter_px = segments == 2 ? 0 : 3;
      options.max_error_px = 1.0;
      EXPECT_EQ(settled(options, mapping).patches_uncovered, 0);
      EXPECT_EQ(background(), 0) << segments << " segments";
    }
  }
}

}  // namespace
}  // namespace terrella::test
