// Frames into a framebuffer with four samples a pixel: edges cover the samples that they cover.
#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "caller_scene.h"

namespace terrella::test {
namespace {

/// Pixels with some red, but not the most.
int partly_red(const Picture& picture, int most) {
  int found = 0;
  for (int y = 0; y < picture.size.height_px; ++y) {
    for (int x = 0; x < picture.size.width_px; ++x) {
      const int red = picture.at(x, y)[0];
      found += red > most / 8 && red < most - most / 8 ? 1 : 0;
    }
  }
  return found;
}

class Multisample : public GlTest, public testing::WithParamInterface<DepthMode> {};

// The box of the application ends at the ground, and its edges cover parts of pixels.
TEST_P(Multisample, ACallersBoxMeetsTheGroundWhereRaysSay) {
  for (const DrawStage stage : {DrawStage::ground, DrawStage::all}) {
    const auto globe = globe_of(GetParam(), 1.0);
    const auto box = box_of(*globe);
    const SampledTarget target(kScene);
    globe->on_draw([&](DrawStage at, const FrameMatrices&) {
      if (at == stage) box->draw();
    });
    settle_into(*globe, target, kScene);
    const Picture picture = target.read();
    const auto truth = truth_of(*globe, *box, false);
    EXPECT_GT(std::ranges::count(truth, true), 300);
    EXPECT_EQ(off_by_more_than_a_pixel(reds(picture, 128), truth), 0U);
    EXPECT_GT(partly_red(picture, 255), 40) << "all samples of a pixel have one colour";
  }
}

TEST_P(Multisample, ABoxShowsThroughATranslucentSurface) {
  const auto globe = globe_of(GetParam(), 0.5);
  const auto box = box_of(*globe);
  const SampledTarget target(kScene);
  globe->on_draw([&](DrawStage at, const FrameMatrices&) {
    if (at == DrawStage::below_ground || at == DrawStage::all) box->draw();
  });
  settle_into(*globe, target, kScene);
  EXPECT_EQ(off_by_more_than_a_pixel(reds(target.read(), 64), truth_of(*globe, *box, true)), 0U);
  EXPECT_EQ(off_by_more_than_a_pixel(reds(target.read(), 200), truth_of(*globe, *box, false)), 0U);
}

// After the frame the application draws by itself, with the depth of each sample.
TEST_P(Multisample, DepthOfEachSampleIsCopied) {
  const auto globe = globe_of(GetParam(), 1.0);
  const auto box = box_of(*globe);
  const SampledTarget target(kScene), own(kScene);
  settle_into(*globe, target, kScene);
  ASSERT_TRUE(globe->copy_depth(own.framebuffer()));
  EXPECT_NE(globe->depth_texture(), 0U);
  globe->on_draw([&](DrawStage at, const FrameMatrices&) {
    if (at != DrawStage::all) return;
    glBindFramebuffer(GL_FRAMEBUFFER, own.framebuffer());
    const float black[] = {0, 0, 0, 1};
    glClearNamedFramebufferfv(own.framebuffer(), GL_COLOR, 0, black);
    box->draw();
  });
  globe->render(target.framebuffer(), kScene);
  const Picture picture = own.read();
  EXPECT_EQ(off_by_more_than_a_pixel(reds(picture, 128), truth_of(*globe, *box, false)), 0U);
  EXPECT_GT(partly_red(picture, 255), 40);
}

INSTANTIATE_TEST_SUITE_P(Depths, Multisample,
                         testing::Values(DepthMode::reversed, DepthMode::logarithmic, DepthMode::standard));

class MultisampleOutline : public GlTest {};

// The edges of icons are blended, so they are the same with four samples. The icon is turned, so its edges are slanted.
TEST_F(MultisampleOutline, IconsAreThoseOfOneSample) {
  constexpr Viewport kSeen{96, 96};
  auto globe = make_globe(unlit_options(), one_colour({.tile_px = 16, .max_level = 1}, {0, 160, 0}));
  globe->set_camera(camera_at(0, 0, 3.0e6));
  const auto white = std::make_shared<const IconImage>(IconImage{2, 1, {255, 255, 255, 255, 200, 0, 0, 255}});
  ASSERT_TRUE(
      globe->add_objects({.points = {{.size_px = 50.0F, .icon = {.image = white, .heading = Angle::degrees(20.0)}}}}));
  settle(*globe, kSeen);
  const Picture one = picture();
  const SampledTarget target(kSeen);
  settle_into(*globe, target, kSeen);
  const Picture four = target.read();
  int worst = 0, icon = 0;
  for (std::size_t k = 0; k < one.rgba.size(); ++k) {
    if (k % 4 == 3) continue;
    worst = std::max(worst, std::abs(one.rgba[k] - four.rgba[k]));
    icon += k % 4 == 0 && one.rgba[k] > 100 ? 1 : 0;
  }
  EXPECT_NEAR(icon, 50 * 25, 60);
  EXPECT_LE(worst, 2) << "rounding";
}

// The smooth limb is computed in both, with and without air: the pictures differ by rounding, on and beside the limb.
TEST_F(MultisampleOutline, TheLimbIsThatOfOneSample) {
  constexpr Viewport kDisc{128, 128};
  for (const bool sky : {false, true}) {
    GlobeOptions options;
    options.sky = sky;
    options.unlit = !sky;
    auto globe = make_globe(options, one_colour({.tile_px = 16, .max_level = 1}, {0, 160, 0}));
    globe->set_camera(camera_at(10, 20, 3.0e7));
    settle(*globe, kDisc);
    const Picture one = picture();
    const SampledTarget target(kDisc);
    settle_into(*globe, target, kDisc);
    const Picture four = target.read();
    int worst = 0, off = 0;
    for (std::size_t k = 0; k < one.rgba.size(); ++k) {
      if (k % 4 == 3) continue;
      const int apart = std::abs(one.rgba[k] - four.rgba[k]);
      worst = std::max(worst, apart);
      off += apart > 24 ? 1 : 0;
    }
    RecordProperty(sky ? "worst_sky" : "worst", worst);
    RecordProperty(sky ? "off_sky" : "off", off);
    EXPECT_LT(worst, 40) << (sky ? "sky " : "no sky ") << off;
    EXPECT_LT(off, 10) << (sky ? "sky" : "no sky");
  }
}

// Mountains before black: their outline has colours between, by the samples that it covers.
TEST_F(MultisampleOutline, AnOutlineOfMountainsCoversSamples) {
  GlobeOptions options = unlit_options();
  auto heights = ElevationSource::open(painted_heights({.tile_px = 128, .max_level = 5}, waves_m), "waves");
  ASSERT_TRUE(heights);
  auto globe = Globe::create(options, one_colour({.tile_px = 16, .max_level = 1}, {200, 0, 0}), *heights);
  ASSERT_TRUE(globe);
  (*globe)->set_camera(camera_at(46.0, 7.0, 2000.0, 40.0, -2.0));
  const SampledTarget target(kScene);
  settle_into(**globe, target, kScene);
  EXPECT_GT(partly_red(target.read(), 200), 40);
}

}  // namespace
}  // namespace terrella::test
