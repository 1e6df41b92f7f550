// A translucent surface: how it blends, that it hides itself, and stereo (paper 2, section 2 of the seeds).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/gl/gl_fixture.h"
#include "tests/scene/patch_test_support.h"

namespace terrella::test {
namespace {

constexpr Color kSurface = {200, 120, 40};
constexpr Viewport kPicture{160, 120};
const TileGrid kTranslucentGrid{.tile_px = 64, .max_level = 1};
// Blending rounds once, and the picture once more.
constexpr int kBlendRounding = 1;

GlobeOptions translucent(double alpha) {
  GlobeOptions options = unlit_options();
  options.surface.alpha = alpha;
  return options;
}

void expect_near(const Color& seen, const Color& expected, int tolerance, const std::string& where) {
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(int{seen[k]}, int{expected[k]}, tolerance) << where;
}

Color times(double factor, const Color& c) {
  Color out{};
  for (std::size_t k = 0; k < 3; ++k) out[k] = static_cast<std::uint8_t>(std::lround(std::min(255.0, factor * c[k])));
  return out;
}

class GlobeTranslucency : public GlTest {
 protected:
  std::unique_ptr<Globe> settled_globe(const GlobeOptions& options, const Camera& camera, Viewport size = kPicture) {
    auto globe = make_globe(options, one_colour(kTranslucentGrid, kSurface));
    globe->set_camera(camera);
    settle(*globe, size);
    return globe;
  }
};

TEST_F(GlobeTranslucency, OverTheInnerSphereTheSurfaceHasItsAlphaOfItself) {
  for (const Blend blend : {Blend::normal, Blend::additive}) {
    for (const double alpha : {0.0, 0.25, 0.5, 0.9, 1.0}) {
      GlobeOptions options = translucent(alpha);
      options.surface.blend = blend;
      settled_globe(options, camera_at(10, 20, 3.0e7));
      // Below is the inner sphere, black as the background: A times the surface by (2.7) and by (2.9).
      expect_near(picture().at(80, 60), times(alpha, kSurface), kBlendRounding, "alpha " + std::to_string(alpha));
    }
  }
}

// Air lies before the surface, so it is as bright before glass as before stone. Black ground shows the air alone. With
// half of the air's light there was a bright ring around a dim globe, with a jagged edge.
TEST_F(GlobeTranslucency, TheAirIsNotTranslucent) {
  constexpr int kDither = 3;  // half a level in each of two passes, and two roundings
  for (const int layers : {1, 2}) {
    GlobeOptions options;
    options.sky = true;
    const auto globe = make_globe(options, one_colour(kTranslucentGrid, {0, 0, 0}));
    if (layers == 2) {
      ASSERT_TRUE(globe->add_imagery(one_colour(kTranslucentGrid, {0, 0, 0}), {.opacity = 0.5}));
    }
    for (const double height_m : {3.0e5, 1.5e7}) {
      globe->set_camera(camera_at(10, 20, height_m, 0, height_m < 1.0e6 ? -20 : -90));
      globe->set_surface({});
      settle(*globe, kPicture);
      const Picture opaque = picture();
      globe->set_surface({.alpha = 0.4});
      settle(*globe, kPicture);
      const Picture glass = picture();
      int most = 0, brightest = 0;
      for (std::size_t k = 0; k < glass.rgba.size(); ++k) {
        most = std::max(most, std::abs(int{glass.rgba[k]} - int{opaque.rgba[k]}));
        if (k % 4 == 2) brightest = std::max(brightest, int{opaque.rgba[k]});
      }
      EXPECT_LE(most, kDither) << layers << " layers, " << height_m << " m";
      EXPECT_GT(brightest, 100) << "no air";
    }
  }
}

TEST_F(GlobeTranslucency, TheFarSideNeverShowsThroughTheNearOne) {
  // Without an inner sphere the far side's faces look away and are culled: the same picture.
  for (const bool inner_sphere : {true, false}) {
    GlobeOptions options = translucent(0.5);
    if (!inner_sphere) options.surface.inner_sphere_below_m.reset();
    settled_globe(options, camera_at(0, 0, 1.0e7, 30, -60));
    const Picture seen = picture();
    for (int y = 0; y < kPicture.height_px; ++y) {
      for (int x = 0; x < kPicture.width_px; ++x) {
        const int red = seen.at(x, y)[0];
        EXPECT_LE(red, 100 + kBlendRounding) << x << ' ' << y << ": the surface twice";
      }
    }
  }
}

TEST_F(GlobeTranslucency, TheSameInputGivesTheSamePixels) {
  const auto globe = settled_globe(translucent(0.5), camera_at(0, 0, 2.0e7));
  const Picture one = picture();
  draw(*globe, kPicture);
  EXPECT_EQ(one.rgba, picture().rgba) << "the same input, other pixels";
}

TEST_F(GlobeTranslucency, AnOpaqueSurfaceCostsOnePass) {
  const Camera camera = camera_at(10, 20, 3.0e7);
  const auto opaque = settled_globe(translucent(1.0), camera);
  const FrameStats one = draw(*opaque, kPicture);
  SurfaceLook look;
  look.alpha = 0.5;
  opaque->set_surface(look);
  const FrameStats two = draw(*opaque, kPicture);
  EXPECT_EQ(two.draw_calls, one.draw_calls + 1) << "the surface's depth";
  EXPECT_EQ(two.triangles, one.triangles);
}

TEST_F(GlobeTranslucency, FromBelowTheSurfaceIsOpaqueUnlessItIsAskedNotToBe) {
  const Camera up = camera_at(10, 20, -2.0e5, 0, 80);
  for (const SurfaceFromBelow mode : {SurfaceFromBelow::opaque, SurfaceFromBelow::translucent}) {
    GlobeOptions options = translucent(0.5);
    options.surface.from_below = mode;
    settled_globe(options, up);
    const double seen = mode == SurfaceFromBelow::opaque ? 1.0 : 0.5;
    expect_near(picture().at(80, 60), times(seen, kSurface), kBlendRounding, "from below");
  }
}

TEST_F(GlobeTranslucency, LookingDownFromUnderTheGroundTheInnerSphereIsThere) {
  settled_globe(translucent(0.5), camera_at(10, 20, -2.0e5));
  expect_near(picture().at(80, 60), {0, 0, 0}, 0, "inner sphere");
  GlobeOptions without = translucent(1.0);
  without.surface.inner_sphere_below_m.reset();
  settled_globe(without, camera_at(10, 20, -2.0e5));
  expect_near(picture().at(80, 60), kSurface, 0, "far wall");
}

TEST_F(GlobeTranslucency, AColouredInnerSphereShowsThroughAndLooksRound) {
  GlobeOptions options = translucent(0.5);
  options.surface.inner_sphere_srgb = {0.2F, 0.4F, 0.8F};
  settled_globe(options, camera_at(10, 20, 3.0e7));
  const Color below{51, 102, 204};
  Color mixed{};
  for (std::size_t k = 0; k < 3; ++k) mixed[k] = static_cast<std::uint8_t>((kSurface[k] + below[k] + 1) / 2);
  expect_near(picture().at(80, 60), mixed, 2, "the middle");
  // The inner sphere's rim, and the curtain beside it, are a third as bright.
  const double focal_px = 60.0 / std::tan(20.0 * std::numbers::pi / 180.0);
  const double rim_px = focal_px * 6378137.0 / (3.0e7 + 6378137.0);
  const int near_rim = picture().at(80 + static_cast<int>(0.9 * rim_px), 60)[2];
  EXPECT_NEAR(near_rim, 0.5 * (kSurface[2] + 0.35 * below[2]), 4);
  options.surface.inner_sphere_srgb = glm::vec3(0.0F);
  settled_globe(options, camera_at(10, 20, 3.0e7));
  expect_near(picture().at(80, 60), times(0.5, kSurface), kBlendRounding, "black");
}

class GlobeStereo : public GlobeTranslucency {};

/// The columns of a row's first and last pixel that is not background, of those that `of` selects.
struct Span {
  int first = -1, last = -1;
};
template <class Lit>
Span span_of_row(const Picture& seen, int y, int from, int to, Lit lit) {
  Span span;
  for (int x = from; x < to; ++x) {
    if (!lit(seen.at(x, y))) continue;
    if (span.first < 0) span.first = x - from;
    span.last = x - from;
  }
  return span;
}

TEST_F(GlobeStereo, EachEyeSeesTheGlobeWhereItsOwnCameraWould) {
  // A stereo pair straight down over the equator; convergence at the surface, separation given.
  constexpr Viewport kWide{320, 120};
  constexpr double kHeight_m = 2.0e7, kSeparation_m = 1.0e6;
  GlobeOptions options = unlit_options();
  options.stereo = {.mode = Stereo::side_by_side, .eye_separation_m = kSeparation_m};
  settled_globe(options, camera_at(0, 0, kHeight_m), kWide);
  const auto lit = [](const Color& c) { return c[0] > 100; };
  const Picture seen = picture();
  const Span left = span_of_row(seen, 60, 0, 160, lit), right = span_of_row(seen, 60, 160, 320, lit);
  // The disc's middle is behind the screen: for an eye e to the side, its centre at distance D appears at
  // -e / D + e / C of slope (C the convergence distance), and so much further right for the left eye.
  const double focal_px = 60.0 / std::tan(20.0 * std::numbers::pi / 180.0);
  const double centre_m = kHeight_m + 6378137.0;
  const double parallax_px = kSeparation_m * (1.0 / kHeight_m - 1.0 / centre_m) * focal_px;
  const double left_middle = 0.5 * (left.first + left.last), right_middle = 0.5 * (right.first + right.last);
  EXPECT_NEAR(right_middle - left_middle, parallax_px, 1.0) << "pixels are whole";
}

TEST_F(GlobeStereo, InterlacedRowsAreTheRowsOfTheTwoEyes) {
  GlobeOptions options = translucent(0.5);
  const Camera camera = camera_at(20, 30, 2.0e7, 15, -75);
  options.stereo = {.mode = Stereo::interlaced, .eye_separation_m = 1.5e6};
  settled_globe(options, camera);
  const Picture both = picture();
  options.stereo.mode = Stereo::side_by_side;
  settled_globe(options, camera, {2 * kPicture.width_px, kPicture.height_px});
  const Picture pair = picture();
  int different = 0;
  for (int y = 0; y < kPicture.height_px; ++y) {
    for (int x = 0; x < kPicture.width_px; ++x) {
      const Color one = both.at(x, y), other = pair.at(x + (y % 2 == 0 ? 0 : kPicture.width_px), y);
      different += one != other ? 1 : 0;
    }
  }
  // The limb's antialiasing takes its colours from whole rows, so there, and only there, the pictures may differ.
  EXPECT_LE(different, kPicture.width_px + kPicture.height_px);
}

TEST_F(GlobeStereo, AnaglyphHasTheLeftEyeInRedAndTheRightOneInGreenAndBlue) {
  GlobeOptions options = unlit_options();
  const Camera camera = camera_at(20, 30, 2.0e7);
  options.stereo = {.mode = Stereo::anaglyph, .eye_separation_m = 1.5e6};
  settled_globe(options, camera);
  const Picture both = picture();
  options.stereo.mode = Stereo::side_by_side;
  settled_globe(options, camera, {2 * kPicture.width_px, kPicture.height_px});
  const Picture pair = picture();
  int wrong = 0;
  for (int y = 0; y < kPicture.height_px; ++y) {
    for (int x = 0; x < kPicture.width_px; ++x) {
      const Color seen = both.at(x, y), left = pair.at(x, y), right = pair.at(x + kPicture.width_px, y);
      wrong += seen[0] != left[0] || seen[1] != right[1] || seen[2] != right[2] ? 1 : 0;
    }
  }
  // A pixel that an edge crosses at its centre may fall to either side where the picture begins elsewhere.
  EXPECT_LE(wrong, 3);
}

TEST_F(GlobeStereo, WhatBothEyesShareIsChosenOnce) {
  GlobeOptions options = unlit_options();
  const Camera camera = camera_at(20, 30, 2.0e6);
  const auto globe = settled_globe(options, camera);
  const FrameStats one = draw(*globe, kPicture);
  globe->set_stereo({.mode = Stereo::anaglyph, .eye_separation_m = {}});
  settle(*globe, kPicture);
  const FrameStats two = draw(*globe, kPicture);
  EXPECT_LE(two.patches, one.patches * 13 / 10) << "one selection, a little wider";
  EXPECT_LE(two.tiles_wanted, one.tiles_wanted * 13 / 10 + 2);
}

}  // namespace
}  // namespace terrella::test
