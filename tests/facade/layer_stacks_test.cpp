// Image layers that one pass combines, judged against the same layers in a pass each, blended by OpenGL.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "globe/experiments.h"
#include "tests/gl/gl_fixture.h"
#include "tests/gl/layer_source.h"
#include "tests/gl/painted_heights.h"
#include "tests/scene/patch_test_support.h"

namespace terrella::test {
namespace {

constexpr Viewport kStacked{128, 128};
// A pass of its own rounds each blend to eight bits, and the layers over it keep a part of that. Of seven layers this
// adds up to 1.3 levels, and the last rounding to half a level more, and dithering to another half. Few pixels have
// roundings of one sign.
constexpr int kRoundedOnce = 1, kRoundedSevenTimes = 3;
constexpr double kFew = 0.02;

std::uint8_t ripple(double deg, double middle, double phase) {
  return static_cast<std::uint8_t>(std::lround(middle + 60.0 * std::sin(deg * (3.14159265 / 180.0) * 3.0 + phase)));
}

TileGrid grid(double root_deg, int tile_px, int max_level) {
  return {.root_span_deg = root_deg, .tile_px = tile_px, .max_level = max_level};
}

LayerSource::Paint paint(double phase, std::uint8_t alpha) {
  return [phase, alpha](double lon, double row) {
    return Rgba{ripple(lon, 120, phase), ripple(row, 110, 2.0 * phase), ripple(lon + row, 130, phase), alpha};
  };
}

std::vector<Camera> stack_cameras() {
  return {camera_at(5, 20, 1.0e7), camera_at(90, 0, 6.0e6), camera_at(-90, 30, 2.0e6),
          camera_at(2, 180, 1.5e6, 30, -60), camera_at(40, -179.9, 3.0e5, 10, -20)};
}

class LayerStacks : public GlTest {
 protected:
  static void add(Globe& globe, const TileGrid& tiles, LayerSource::Paint painted, const ImageLook& look = {},
                  LayerSource::Lacks lacks = {}) {
    ASSERT_TRUE(globe.add_imagery(std::make_shared<LayerSource>(tiles, std::move(painted), std::move(lacks)), look));
  }
  // Other grids and levels, holes, bounds, brightness, day and night: more layers than fit one pass.
  static void add_all(Globe& globe) {
    TileGrid bounded = grid(180, 64, 4);
    bounded.bounds = {.west = Angle::degrees(-10.0),
                      .south = Angle::degrees(-20.0),
                      .east = Angle::degrees(35.0),
                      .north = Angle::degrees(90.0)};
    add(globe, grid(180, 64, 4), paint(0.0, 255));
    add(globe, grid(360, 32, 6), paint(1.0, 255), {.opacity = 0.5});
    add(globe, bounded, paint(2.0, 255), {.opacity = 0.7});
    add(globe, grid(180, 64, 1), paint(3.0, 128), {.opacity = 0.8});
    add(globe, grid(180, 64, 4), paint(4.0, 255), {.opacity = 0.6},
        [](const TileId& id) { return id.x < std::int64_t{1} << id.level; });
    add(globe, grid(180, 64, 4), paint(5.0, 255), {.opacity = 0.4, .alpha = AlphaFrom::brightness});
    add(globe, grid(288, 64, 4), paint(6.0, 255), {.opacity = 0.5, .daylight = Daylight::night});
  }
  Picture drawn(Globe& globe, bool one_by_one) {
    Experiments::of(globe).layers_one_by_one = one_by_one;
    settle(globe, kStacked);
    calls_ = draw(globe, kStacked).draw_calls;
    return picture();
  }
  // Pixels that differ by more than `level` levels.
  static int farther(const Picture& a, const Picture& b, int level) {
    int count = 0;
    for (std::size_t k = 0; k < a.rgba.size(); ++k) count += std::abs(a.rgba[k] - b.rgba[k]) > level ? 1 : 0;
    return count;
  }
  void expect_same(Globe& globe) {
    int together_calls = 0, apart_calls = 0;
    for (const Camera& camera : stack_cameras()) {
      globe.set_camera(camera);
      const Picture together = drawn(globe, false);
      together_calls += calls_;
      const Picture apart = drawn(globe, true);
      apart_calls += calls_;
      SCOPED_TRACE(testing::Message() << camera.eye.lat.deg() << ' ' << camera.eye.height_m);
      EXPECT_EQ(farther(together, apart, kRoundedSevenTimes), 0);
      EXPECT_LT(farther(together, apart, kRoundedOnce), kFew * double(together.rgba.size()));
    }
    EXPECT_LT(together_calls, apart_calls);
  }
  std::unique_ptr<Globe> globe_of(const GlobeOptions& options) {
    auto globe = Globe::create(options);
    EXPECT_TRUE(globe);
    return globe ? std::move(*globe) : nullptr;
  }
  int calls_ = 0;
};

TEST_F(LayerStacks, OnePassIsThePassesOneByOne) {
  const auto globe = globe_of(unlit_options());
  add_all(*globe);
  expect_same(*globe);
}

TEST_F(LayerStacks, InTheLightOfALampAndAtTheLimb) {
  const auto globe = globe_of({});
  add_all(*globe);
  expect_same(*globe);
}

TEST_F(LayerStacks, InTheAirByDayAndNight) {
  GlobeOptions options;
  options.sky = true;
  options.time = *parse_utc("2026-03-20T18:30Z");
  options.night_lights = {64, 32, std::vector<std::uint8_t>(64 * 32, 200)};
  const auto globe = globe_of(options);
  add_all(*globe);
  expect_same(*globe);
}

TEST_F(LayerStacks, OnRelief) {
  const auto heights = ElevationSource::open(
      painted_heights({.tile_px = 64, .max_level = 2},
                      [](double lat, double lon) { return 3000.0 * std::sin(20.0 * lat) * std::cos(20.0 * lon); }),
      "heights");
  ASSERT_TRUE(heights);
  const auto globe = globe_of({});
  add_all(*globe);
  ASSERT_TRUE(globe->set_elevation(*heights));
  expect_same(*globe);
}

TEST_F(LayerStacks, AnOpaqueLayerIsDrawnAloneWhereItHides) {
  const auto globe = globe_of(unlit_options());
  add_all(*globe);
  const auto top = globe->add_imagery(std::make_shared<LayerSource>(grid(180, 64, 4), paint(7.0, 255)));
  ASSERT_TRUE(top);
  globe->set_camera(camera_at(5, 20, 1.0e7));
  const Picture all = drawn(*globe, false);
  const int all_calls = calls_;
  for (const LayerId id : globe->imagery()) {
    if (id == *top) continue;
    ASSERT_TRUE(globe->set_look(id, {.shown = false}));
  }
  EXPECT_EQ(farther(all, drawn(*globe, false), 0), 0);
  EXPECT_EQ(all_calls, calls_);
}

}  // namespace
}  // namespace terrella::test
