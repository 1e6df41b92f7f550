// The eye and the hand on ground that rises and sinks.
#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "relief_test_support.h"
#include "tests/scene/patch_test_support.h"
#include "view/navigation.h"

namespace terrella {
namespace {

using test::camera_at;
using test::WavyGround;

constexpr double kHeldOnRelief_px = 0.05;
constexpr double kLeastOver_m = 1.0 - 1e-6;  // bound of height_range(), rounding aside
constexpr double kStep_s = 1.0 / 60.0;
constexpr Viewport kWindow{800, 600};

struct Walker {
  Walker(const Camera& start, const WavyGround& wavy) : ground(wavy.ground()), navigator(start, ground, kWindow) {}

  [[nodiscard]] double over_m() const { return ground.height_over_m(navigator.camera().eye); }
  [[nodiscard]] View view() const { return make_view(navigator.camera(), ground.ellipsoid(), kWindow); }
  void frame() { navigator.advance(now += Seconds(kStep_s)); }

  Ground ground;
  Navigator navigator;
  Seconds now{5.0};
};

WavyGround high_mountains() {
  WavyGround wavy(9000.0, 20.0, 18);
  wavy.add_level(WavyGround::kLevel);
  return wavy;
}

double distance_m(const Geodetic& a, const Geodetic& b) {
  return glm::distance(earth().ellipsoid.to_ecef({a.lat, a.lon, 0.0}).xyz_m,
                       earth().ellipsoid.to_ecef({b.lat, b.lon, 0.0}).xyz_m);
}

TEST(ReliefNavigation, PanningOverMountainsTheEyeNeverGoesUnderThemAndRisesWithTheirSlope) {
  const WavyGround wavy = high_mountains();
  const double slope_m = wavy.ground().height_m(Angle::degrees(0.2), Angle::degrees(3.0));
  Walker walker(camera_at(0.2, 3.0, slope_m + 5.0, 10.0, -60.0), wavy);
  double raised_m = 0.0, way_m = 0.0;
  for (int press = 0; press < 100; ++press) {
    walker.navigator.key(NavigationKey::pan_up, walker.now);
    for (int k = 0; k < 15; ++k) {
      const Geodetic before = walker.navigator.camera().eye;
      walker.frame();
      const Geodetic& eye = walker.navigator.camera().eye;
      ASSERT_GE(walker.over_m(), kLeastOver_m);
      const double step_m = distance_m(before, eye);
      // 180 km up and down in 10°, 1100 km: a slope of at most π · 180 / 1100, twice that along a diagonal.
      constexpr double kSteepest = 1.1;
      EXPECT_LE(eye.height_m - before.height_m, kSteepest * step_m + 0.01) << "a jump";
      raised_m = std::max(raised_m, eye.height_m - before.height_m);
      way_m += step_m;
    }
  }
  EXPECT_GT(raised_m, 0.0) << "no mountain stood in the way: nothing was tested";
  EXPECT_GT(way_m, 5.0);
}

TEST(ReliefNavigation, AnotherGroundNeitherStopsTheMotionNorForgetsHowDeepTheEyeMayGo) {
  Walker walker(camera_at(0.2, 3.0, 2e5), high_mountains());
  walker.navigator.set_deepest(-5e5);
  walker.navigator.fly_to(camera_at(0.2, 3.0, -3e5), walker.now);
  walker.frame();
  walker.navigator.set_ground(Ground(earth().ellipsoid));
  EXPECT_TRUE(walker.navigator.animating());
  for (int k = 0; k < 6000 && walker.navigator.animating(); ++k) walker.frame();
  EXPECT_NEAR(walker.navigator.camera().eye.height_m, -3e5, 1.0);
}

TEST(ReliefNavigation, ZoomingInEndsAMetreOverTheGroundUnderTheCursorAndHoldsIt) {
  const WavyGround wavy = high_mountains();
  Walker walker(camera_at(3.0, 1.0, 8.0e5), wavy);
  const glm::dvec2 cursor(500.0, 260.0);
  const Grab held = grab(walker.view(), walker.ground, cursor);
  ASSERT_TRUE(held.on_surface);
  walker.navigator.wheel(cursor, 5.0, walker.now);
  while (walker.navigator.animating()) {
    walker.frame();
    ASSERT_GE(walker.over_m(), kLeastOver_m);
    const auto seen = project(walker.view(), held.point);
    ASSERT_TRUE(seen);
    EXPECT_LT(glm::distance(*seen, cursor), kHeldOnRelief_px);
  }
  const double point_m = earth().ellipsoid.to_geodetic(held.point).height_m;
  EXPECT_NEAR(walker.navigator.camera().eye.height_m - point_m, (8.0e5 - point_m) * std::pow(0.8, 5.0), 10.0);
  for (int turn = 0; turn < 30; ++turn) {
    walker.navigator.wheel({400.0, 300.0}, 10.0, walker.now);
    for (int k = 0; k < 40; ++k) walker.frame();
    ASSERT_GE(walker.over_m(), kLeastOver_m);
  }
  EXPECT_LT(walker.over_m(), 2.0);
}

TEST(ReliefNavigation, ADragHoldsTheMountainUnderTheCursor) {
  const WavyGround wavy = high_mountains();
  for (const Camera& start : {camera_at(3.0, 1.0, 8.0e5, 20.0, -70.0), camera_at(88.0, 1.0, 2.0e6),
                              camera_at(-10.0, 179.9, 6.0e5, 300.0, -50.0)}) {
    Walker walker(start, wavy);
    const glm::dvec2 from(420.0, 330.0), to(300.0, 200.0);
    const Grab held = grab(walker.view(), walker.ground, from);
    ASSERT_TRUE(held.on_surface);
    walker.navigator.pointer_down(PointerButton::left, false, from, walker.now);
    for (int k = 1; k <= 20; ++k) {
      walker.navigator.pointer_move(from + (to - from) * (k / 20.0), walker.now += Seconds(kStep_s));
      ASSERT_GE(walker.over_m(), kLeastOver_m);
    }
    const auto seen = project(walker.view(), held.point);
    ASSERT_TRUE(seen);
    EXPECT_LT(glm::distance(*seen, to), kHeldOnRelief_px);
  }
}

TEST(ReliefNavigation, TurningAroundAPointTheEyeIsTiltedOverTheMountains) {
  const WavyGround wavy = high_mountains();
  Walker walker(camera_at(3.0, 1.0, 4.0e5, 0.0, -50.0), wavy);
  const glm::dvec2 middle(400.0, 300.0);
  const Grab pivot = grab(walker.view(), walker.ground, middle);
  ASSERT_TRUE(pivot.on_surface);
  walker.navigator.pointer_down(PointerButton::right, false, middle, walker.now);
  for (int k = 1; k <= 60; ++k) {
    walker.navigator.pointer_move(middle + glm::dvec2(20.0 * k, -15.0 * k), walker.now += Seconds(kStep_s));
    ASSERT_GE(walker.over_m(), kLeastOver_m);
    const auto seen = project(walker.view(), pivot.point);
    ASSERT_TRUE(seen);
    EXPECT_LT(glm::distance(*seen, middle), 1.0);
  }
}

TEST(ReliefNavigation, HeightsThatArriveRaiseTheEyeOnlyIfItIsUnderThem) {
  WavyGround wavy(9000.0, 20.0);
  const Camera high = camera_at(5.0, 3.0, 4.0e5, 10.0, -40.0), low = camera_at(5.0, 3.0, 3000.0, 10.0, -5.0);
  Walker over(high, wavy), under(low, wavy);
  over.frame();
  under.frame();
  EXPECT_EQ(under.navigator.camera().eye.height_m, 3000.0) << "no heights yet: over the ellipsoid";
  wavy.add_level(WavyGround::kLevel);
  over.frame();
  under.frame();
  EXPECT_EQ(over.navigator.camera().eye.height_m, 4.0e5);
  const double ground_m = wavy.ground().height_m(low.eye.lat, low.eye.lon);
  ASSERT_GT(ground_m, 5.0e4);
  EXPECT_DOUBLE_EQ(under.navigator.camera().eye.height_m, ground_m + 1.0);
  EXPECT_EQ(under.navigator.camera().pitch, low.pitch);
  EXPECT_EQ(under.navigator.camera().eye.lon, low.eye.lon);
}

TEST(ReliefNavigation, UnderTheGroundTheEyeStaysThereIfItMay) {
  const WavyGround wavy = high_mountains();
  const Camera start = camera_at(5.0, 3.0, -2.0e5, 0.0, 40.0);
  Walker walker(start, wavy);
  walker.navigator.set_deepest(-8.0e5);
  walker.frame();
  EXPECT_EQ(walker.navigator.camera().eye.height_m, -2.0e5);
  for (int k = 0; k < 40; ++k) {
    walker.navigator.key(NavigationKey::zoom_out, walker.now);
    for (int step = 0; step < 60; ++step) walker.frame();
  }
  EXPECT_EQ(walker.navigator.camera().eye.height_m, -8.0e5);
  for (int k = 0; k < 60; ++k) {
    walker.navigator.key(NavigationKey::zoom_in, walker.now);
    for (int step = 0; step < 60; ++step) walker.frame();
  }
  EXPECT_LT(walker.over_m(), 0.0) << "coming nearer does not go through";
  walker.navigator.set_deepest({});
  walker.frame();
  EXPECT_GE(walker.over_m(), kLeastOver_m);
}

}  // namespace
}  // namespace terrella
