// The limb of a globe against the same picture drawn 8 by 8 times as large: no comb of steps along the limb, and no
// dashes of ice, with a sky and without.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "apps/bench/truth/limb_rows.h"
#include "tests/gl/gl_fixture.h"
#include "tests/scene/patch_test_support.h"

namespace terrella::test {
namespace {

using truth::compare_limbs;
using truth::Levels;
using truth::LimbPair;

constexpr int kTimes = 8;

/// Painted land, sea and floes, as a pyramid of means.
std::shared_ptr<PaintedSource> floes() {
  auto source = std::make_shared<PaintedSource>(TileGrid{.tile_px = 128, .max_level = 4}, truth::floe_color);
  source->average(3);
  return source;
}

class LimbPictures : public GlTest {
 protected:
  Levels drawn(Viewport size, int times) {
    settle(*globe_, size);
    return truth::reduced(picture().rgba, size.width_px, size.height_px, times);
  }
  /// The left limb of a square picture, in each channel.
  std::array<LimbPair, 3> limbs(const Camera& camera, int size) {
    globe_->set_camera(camera);
    const Levels truth = drawn({kTimes * size, kTimes * size}, kTimes), seen = drawn({size, size}, 1);
    std::array<LimbPair, 3> pairs;
    for (std::size_t c = 0; c < 3; ++c)
      pairs[c] = compare_limbs(seen, truth, size / 5, size * 4 / 5, static_cast<int>(c));
    return pairs;
  }
  /// `least`: the part of the truth's change from row to row that is drawn.
  void check(const Camera& camera, int size, bool sky, double least = 0.9) {
    SCOPED_TRACE("from " + std::to_string(camera.eye.height_m) + " m, " + std::to_string(size) + " px, sky " +
                 std::to_string(int(sky)));
    globe_->set_sky(sky);
    const std::array<LimbPair, 3> channels = limbs(camera, size);
    for (std::size_t c = 0; c < 3; ++c) {
      const LimbPair& limb = channels[c];
      EXPECT_TRUE(limb.peak_agrees()) << "channel " << c << ": " << limb.drawn.peak << ", truth " << limb.truth.peak;
      EXPECT_LE(limb.drawn.change, 1.1 * limb.truth.change + 0.5) << "comb in channel " << c;
      EXPECT_GE(limb.drawn.change, least * limb.truth.change - 0.5) << "blur in channel " << c;
    }
  }
  void SetUp() override {
    GlTest::SetUp();
    GlobeOptions options;
    options.sky = true;
    globe_ = make_globe(options, floes());
  }
  void TearDown() override {
    globe_.reset();
    GlTest::TearDown();
  }
  std::unique_ptr<Globe> globe_;
};

TEST_F(LimbPictures, HasNoCombWithASky) {
  check(camera_at(20.9, 0.1, 15202000), 200, true);
  // Floes are narrow there, and a pixel of the limb is longer than the taps reach, so its tile is coarser than the
  // pixel.
  check(camera_at(75.0, 10.0, 40000000, 30), 160, true, 0.82);
}

TEST_F(LimbPictures, HasNoDashesWithoutASky) { check(camera_at(-40.0, 130.0, 12000000, 30), 160, false); }

// A full grid over a pole beside the limb. Pixels there are long along the parallel, up to a hundred texels, and reach
// far over their patches. The painted ground changes within a pixel, so sixteen taps leave specks.
TEST_F(LimbPictures, HasNoSpecksOverAPole) {
  constexpr double kSpeck_levels = 15.0;
  constexpr Viewport kStrip{76, 44}, kLarge{kTimes * kStrip.width_px, kTimes * kStrip.height_px};
  globe_->set_sky(false);
  globe_->set_camera(camera_at(-58.5, 141.0, 2.07e6, 183, -43.1, 11.58));
  const Levels truth = drawn(kLarge, kTimes), seen = drawn(kStrip, 1);
  int specks = 0;
  for (std::size_t k = 0; k < seen.values.size(); ++k)
    specks += std::abs(seen.values[k] - truth.values[k]) > kSpeck_levels;
  EXPECT_LT(specks, 110) << "values of ground that are far off";  // 89; 157 with sixteen taps, 133 with mirrored ones
}

// Ice beyond 67.5 degrees, seen as a rim of up to a third of a pixel on the left. It has as much light in a pixel that
// lies mostly outside the limb as in one that lies inside.
TEST_F(LimbPictures, KeepTheLightOfIceThinnerThanAPixel) {
  globe_.reset();
  auto ice = std::make_shared<PaintedSource>(TileGrid{.tile_px = 128, .max_level = 4}, [](double, double lat_deg) {
    return lat_deg > 67.5 ? Color{235, 240, 245} : Color{20, 40, 90};
  });
  ice->average(3);
  globe_ = make_globe({}, ice);
  for (const LimbPair& limb : limbs(camera_at(0.0, 20.0, 1.52e7, 90), 200))
    EXPECT_TRUE(limb.peak_agrees()) << limb.drawn.peak << ", truth " << limb.truth.peak;
}

// Floes along a strip of the limb, from 26,000 km. A pixel on the limb shows the ground of its own part inside the
// limb, not that of pixels beside it. The ground is 20 to 245 levels bright.
TEST_F(LimbPictures, ShowInEachPixelItsOwnGround) {
  constexpr Viewport kStrip{306, 86}, kLarge{kTimes * kStrip.width_px, kTimes * kStrip.height_px};
  globe_->set_sky(false);
  globe_->set_camera(camera_at(40.5, 118.0, 29763514.4, 134, -80.506531, 1.98995698));
  const Levels truth = drawn(kLarge, kTimes), seen = drawn(kStrip, 1);
  double squares = 0.0;
  int pixels = 0;
  for (int x = 0; x < kStrip.width_px; ++x) {
    int y = 0;
    while (y < kStrip.height_px && truth.at(x, y, 2) < 4.0) ++y;
    for (int k = 0; k < 2 && y + k < kStrip.height_px; ++k, ++pixels) {
      const double off = seen.at(x, y + k, 0) - truth.at(x, y + k, 0);
      squares += off * off;
    }
  }
  ASSERT_GT(pixels, 500);
  const double rms = std::sqrt(squares / pixels);
  RecordProperty("rms", std::to_string(rms));
  EXPECT_LT(rms, 6.0);
}

// A layer of one colour, over ground of one colour: each pixel of the globe has the layer once, also where the limb's
// triangles overlap those of whole patches.
TEST_F(LimbPictures, HaveALayerOnce) {
  constexpr Viewport kPicture{300, 300};
  for (const double alpha : {1.0, 0.5}) {
    globe_.reset();
    GlobeOptions options;
    options.surface.alpha = alpha;
    options.surface.inner_sphere_below_m = 1.0e5;
    const TileGrid grid{.tile_px = 64, .max_level = 2};
    globe_ = make_globe(options, one_colour(grid, {200, 200, 200}));
    globe_->set_camera(camera_at(20.0, 10.0, 1.5e7));
    settle(*globe_, kPicture);
    const Picture bare = picture();
    ASSERT_TRUE(globe_->add_imagery(one_colour(grid, {0, 0, 0}), {.opacity = 0.5}));
    settle(*globe_, kPicture);
    const Picture covered = picture();
    for (int y = 0; y < kPicture.height_px; ++y)
      for (int x = 0; x < kPicture.width_px; ++x)
        ASSERT_NEAR(covered.at(x, y)[0], 0.5 * bare.at(x, y)[0], 2.0) << x << ", " << y << ", alpha " << alpha;
  }
}

// Pixels at the limb are many times as long as wide, and their texels must still be about as narrow as they are.
TEST_F(LimbPictures, IsNotBlurred) { check(camera_at(58.5, 32.0, 48329000, 256, -90, 15.9), 192, false, 0.87); }

// A ball whose centre lies under the ground, and which stands out over the limb. The Sun is over the eye's shoulder.
TEST_F(LimbPictures, HaveNoAirOverAnObject) {
  constexpr Viewport kPicture{400, 400};
  constexpr double kRadius_m = 6.0e5;
  const PointObject ball{.place = {.lat = Angle::degrees(20.0), .lon = Angle::degrees(72.0), .height_m = -1.0e5},
                         .radius_m = kRadius_m,
                         .color = {255, 64, 32, 255}};
  ASSERT_TRUE(globe_->add_objects({.points = {ball}}));
  const Camera camera = camera_at(20.9, 0.1, 15202000);
  globe_->set_camera(camera);
  const View view = make_view(camera, earth().ellipsoid, kPicture);
  const glm::dvec3 center = earth().ellipsoid.to_ecef(ball.place).xyz_m - view.eye.xyz_m;
  globe_->set_sky(false);
  settle(*globe_, kPicture);
  const Picture bare = picture();
  globe_->set_sky(true);
  settle(*globe_, kPicture);
  const Picture seen = picture();
  int pixels = 0;
  for (int y = 0; y < kPicture.height_px; ++y) {
    for (int x = 0; x < kPicture.width_px; ++x) {
      const glm::dvec3 ray = pixel_ray(view, {x + 0.5, y + 0.5}).xyz;
      if (glm::length(center - glm::dot(center, ray) * ray) > 0.9 * kRadius_m) continue;
      if (pick(view, earth().ellipsoid, {x + 0.5, y + 0.5})) continue;
      EXPECT_EQ(seen.at(x, y), bare.at(x, y)) << x << ", " << y;
      ++pixels;
    }
  }
  EXPECT_GT(pixels, 100) << "the ball is not over the limb";
}

}  // namespace
}  // namespace terrella::test
