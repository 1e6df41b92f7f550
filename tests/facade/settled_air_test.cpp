// The air of a settled picture depends on the view alone, not on the views before it.
#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

#include "tests/gl/gl_fixture.h"
#include "tests/gl/layer_source.h"
#include "tests/scene/patch_test_support.h"

namespace terrella::test {
namespace {

constexpr Viewport kSides{160, 120};
constexpr double kSmallStep = 1.0 + 1.0e-3;  // factor of the eye's height; a frame in motion keeps the air before

class SettledAir : public GlTest {
 protected:
  static std::unique_ptr<Globe> sky_globe(std::optional<UtcTime> time) {
    GlobeOptions options;
    options.sky = true;
    options.time = time;
    auto source = std::make_shared<LayerSource>(TileGrid{.tile_px = 64, .max_level = 5}, [](double, double) {
      return Rgba{40, 60, 90, 255};
    });
    auto globe = Globe::create(options, std::move(source));
    EXPECT_TRUE(globe);
    return globe ? std::move(*globe) : nullptr;
  }
  Picture settled(Globe& globe) {
    settle(globe, kSides);
    return picture();
  }
  /// Draws frames as a window does, until none is needed.
  Picture at_rest(Globe& globe) {
    do {
      draw(globe, kSides);
    } while (!globe.settled() || globe.needs_frame());
    return picture();
  }
};

TEST_F(SettledAir, IsThatOfANewGlobe) {
  for (const double height_m : {3.0e3, 5.0e4, 2.0e6, 9.0e6}) {
    const Camera before = camera_at(20, 10, height_m, 30, height_m < 1.0e6 ? -20 : -80);
    Camera after = before;
    after.eye.height_m *= kSmallStep;
    const auto moved = sky_globe({}), fresh = sky_globe({});
    ASSERT_TRUE(moved && fresh);
    moved->set_camera(before);
    std::ignore = at_rest(*moved);
    moved->set_camera(after);
    fresh->set_camera(after);
    EXPECT_TRUE(at_rest(*moved).rgba == settled(*fresh).rgba) << height_m << " m";
  }
}

TEST_F(SettledAir, IsThatOfANewGlobeAtAnotherSize) {
  constexpr Viewport kLarger{1280, 960};
  const Camera camera = camera_at(20, -40, 9.0e6);
  const auto grown = sky_globe({}), fresh = sky_globe({});
  ASSERT_TRUE(grown && fresh);
  grown->set_camera(camera);
  fresh->set_camera(camera);
  std::ignore = at_rest(*grown);
  settle(*grown, kLarger);
  const Picture after = picture();
  settle(*fresh, kLarger);
  EXPECT_TRUE(after.rgba == picture().rgba);
}

TEST_F(SettledAir, FollowsASmallStepOfTheSun) {
  const UtcTime noon = *parse_utc("2026-06-21T12:00Z"), later = *parse_utc("2026-06-21T12:00:05Z");
  const Camera camera = camera_at(20, 10, 5.0e4, 30, -20);
  const auto moved = sky_globe(noon), fresh = sky_globe(later);
  ASSERT_TRUE(moved && fresh);
  moved->set_camera(camera);
  fresh->set_camera(camera);
  std::ignore = at_rest(*moved);
  EXPECT_TRUE(moved->set_time(later));
  EXPECT_TRUE(at_rest(*moved).rgba == settled(*fresh).rgba);
}

}  // namespace
}  // namespace terrella::test
