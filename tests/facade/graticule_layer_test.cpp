// Lines of latitude and longitude as a layer of a globe: where they are, and how wide.
#include <gtest/gtest.h>

#include "objects/graticule.h"
#include "tests/gl/gl_fixture.h"
#include "tests/scene/patch_test_support.h"

namespace terrella::test {
namespace {

constexpr Viewport kNetted{128, 128};
constexpr double kLineWidth_px = 0.4;  // edges are smooth to a part of a pixel; the ground bends under a line

class GraticuleLayer : public GlTest {
 protected:
  /// White in a column from a row to another, in pixels.
  static double white_px(const Picture& shown, int x, int from, int to) {
    double sum = 0.0;
    for (int y = from; y < to; ++y) sum += shown.at(x, y)[1] / 255.0;
    return sum;
  }
};

TEST_F(GraticuleLayer, LinesAreWhereTheyShouldAndAsWideOnGroundThatIsSeenAtASlant) {
  const auto globe = make_globe(unlit_options(), one_colour({.tile_px = 64, .max_level = 1}, {0, 0, 0}));
  for (const float width_px : {2.0F, 8.0F}) {
    const auto net = globe->add_objects(
        graticule_objects({.spacing_deg = 30.0, .width_px = width_px, .color = {255, 255, 255}, .labels = false}));
    ASSERT_TRUE(net);
    // The second looks at the equator along the ground, as far as a line's width lasts.
    for (const Camera& camera : {camera_at(15, 15, 8.0e6), camera_at(-12, 15, 2.0e6, 0, -45)}) {
      globe->set_camera(camera);
      settle(*globe, kNetted);
      const Picture shown = picture();
      const auto equator = globe->project({.lat = {}, .lon = Angle::degrees(15)}, kNetted);
      ASSERT_TRUE(equator);
      const int y = static_cast<int>(equator->y);
      ASSERT_TRUE(y > 8 && y < 120);
      EXPECT_EQ(shown.at(64, y), (Color{255, 255, 255}));
      EXPECT_NEAR(white_px(shown, 64, y - 8, y + 8), width_px, kLineWidth_px);
    }
    ASSERT_TRUE(globe->remove(*net));
  }
}

}  // namespace
}  // namespace terrella::test
