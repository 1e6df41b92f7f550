// The horizon of lit ground: no gap between basins and the sky, and no jagged coast where the sea mirrors the Sun.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "apps/bench/truth/limb_rows.h"
#include "tests/gl/gl_fixture.h"
#include "tests/gl/painted_heights.h"
#include "tests/scene/patch_test_support.h"

namespace terrella::test {
namespace {

constexpr Viewport kHorizon{160, 160};

class Horizon : public GlTest {
 protected:
  static GlobeOptions sky_options() {
    GlobeOptions options;
    options.sky = true;
    return options;
  }
};

// Sea floor of 3 km, drawn four times as deep, from over the air: the ground ends 10 pixels below the ellipsoid's limb.
// Down a column the light grows through the air, and stays: the ground behind so much air is as bright as the air.
TEST_F(Horizon, HasNoBlackLineOverBasins) {
  constexpr int kBright = 100, kDark = 60;
  auto heights = ElevationSource::open(
      painted_heights({.tile_px = 64, .max_level = 2}, [](double, double lon) { return lon > 3.0 ? 3000.0 : -3000.0; }),
      "basin");
  ASSERT_TRUE(heights);
  GlobeOptions options = sky_options();
  options.exaggeration = 4.0;
  auto globe = Globe::create(options, one_colour({.tile_px = 64, .max_level = 1}, {40, 70, 130}), *heights);
  ASSERT_TRUE(globe);
  (*globe)->set_camera(camera_at(44, 7, 400000, 10, -20, 20));
  settle(**globe, kHorizon);
  const Picture seen = picture();
  int edges = 0;
  for (int x = 0; x < kHorizon.width_px; ++x) {
    bool in_air = false;
    for (int y = 0; y < kHorizon.height_px; ++y) {
      const int blue = seen.at(x, y)[2];
      if (blue > kBright && !in_air) ++edges, in_air = true;
      EXPECT_FALSE(in_air && blue < kDark) << x << ", " << y << ": " << blue;
    }
  }
  EXPECT_EQ(edges, kHorizon.width_px) << "no horizon in the picture";
}

// Winter noon: the Sun stands over the sea in the south, and a coast 830 km away runs through its light. Beside the
// same picture drawn larger: a jagged coast is too bright in one pixel and too dark in the next.
TEST_F(Horizon, HasNoJaggedCoastInTheGlint) {
  constexpr int kTimes = 8;
  constexpr double kCoast_levels = 25.0;
  GlobeOptions options = sky_options();
  options.time = *parse_utc("2026-12-21T11:30Z");
  auto source = std::make_shared<PaintedSource>(TileGrid{.tile_px = 128, .max_level = 5}, [](double lon, double lat) {
    return lat > 38.5 + 0.4 * (lon - 7.0) ? Color{90, 100, 60} : Color{15, 30, 70};
  });
  source->average(3);
  const auto globe = make_globe(options, source);
  globe->set_camera(camera_at(46, 7, 90000, 180, -9.9, 6));
  const Viewport large{kTimes * kHorizon.width_px, kTimes * kHorizon.height_px};
  settle(*globe, large);
  const truth::Levels truth = truth::reduced(picture().rgba, large.width_px, large.height_px, kTimes);
  settle(*globe, kHorizon);
  const truth::Levels seen = truth::reduced(picture().rgba, kHorizon.width_px, kHorizon.height_px, 1);
  double squares = 0.0;
  int coast = 0;
  for (int y = 1; y < kHorizon.height_px; ++y) {
    for (int x = 0; x < kHorizon.width_px; ++x) {
      if (truth.at(x, y - 1, 0) - truth.at(x, y, 0) < kCoast_levels) continue;
      const double off = seen.at(x, y, 0) - truth.at(x, y, 0), over = seen.at(x, y - 1, 0) - truth.at(x, y - 1, 0);
      squares += off * off + over * over;
      ++coast;
    }
  }
  EXPECT_GT(coast, kHorizon.width_px / 2) << "no coast in the glint: nothing was tested";
  EXPECT_LT(std::sqrt(squares / std::max(1, 2 * coast)), 9.0);
}

// The sky meets the ground without dashes: each pixel around the horizon is that of the same picture drawn larger,
// within three levels, which are the rounding and the dither of both pictures and the squares in which light is mixed.
TEST_F(Horizon, HasNoDashes) {
  constexpr int kTimes = 4;
  constexpr double kMost_levels = 3.0;
  const Viewport large{kTimes * kHorizon.width_px, kTimes * kHorizon.height_px};
  const auto globe = make_globe(sky_options(), one_colour({.tile_px = 64, .max_level = 1}, {60, 90, 90}));
  for (const double height_m : {1.1e5, 2.0e5, 4.0e5, 1.0e6, 2.0e6}) {
    const double dip = std::acos(6371e3 / (6371e3 + height_m)) * 180.0 / std::numbers::pi;
    globe->set_camera(camera_at(46, 7, height_m, 0, -dip, 6));
    settle(*globe, large);
    const truth::Levels truth = truth::reduced(picture().rgba, large.width_px, large.height_px, kTimes);
    settle(*globe, kHorizon);
    const truth::Levels seen = truth::reduced(picture().rgba, kHorizon.width_px, kHorizon.height_px, 1);
    double most = 0.0;
    for (int y = 0; y < kHorizon.height_px; ++y) {
      for (int x = 0; x < kHorizon.width_px; ++x) {
        for (int c = 0; c < 3; ++c) most = std::max(most, std::abs(seen.at(x, y, c) - truth.at(x, y, c)));
      }
    }
    EXPECT_LT(most, kMost_levels) << "from " << height_m << " m";
  }
}

}  // namespace
}  // namespace terrella::test
