#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/scene/navigation_hand.h"
#include "tests/scene/patch_test_support.h"
#include "view/navigation.h"

namespace terrella::test {
namespace {

TEST(Wheel, KeepsThePointUnderTheCursor) {
  for (const Camera& start :
       {camera_at(46.0, 7.0, 3.0e6), camera_at(46.0, 179.9, 3.0e5, 30.0, -40.0), camera_at(89.0, 0.0, 4.0e6)}) {
    for (const double steps : {1.0, 5.0, -2.0}) {
      Hand hand(start);
      const glm::dvec2 px(650.0, 500.0);
      const Ecef held = hand.under(px);
      hand.navigator.wheel(px, steps, hand.now);
      while (hand.navigator.animating()) {
        hand.navigator.advance(hand.now += Seconds(kFrame_s));
        ASSERT_LT(hand.miss_px(held, px), kHeld_px);
      }
      EXPECT_NEAR(hand.navigator.camera().eye.height_m / (start.eye.height_m * std::pow(0.8, steps)), 1.0, 1e-9);
    }
  }
}

TEST(Wheel, StepsAddUpWhileTheZoomStillRuns) {
  Hand hand(camera_at(46.0, 7.0, 1.0e6));
  for (int i = 0; i < 3; ++i) hand.navigator.wheel(kCentre, 1.0, hand.now += Seconds(0.01));
  hand.settle();
  EXPECT_NEAR(hand.navigator.camera().eye.height_m, 1.0e6 * 0.512, 1.0);
}

TEST(Wheel, StaysBetweenTheGroundAndFiftyRadii) {
  Hand hand(camera_at(46.0, 7.0, 1.0e3));
  for (int i = 0; i < 40; ++i) hand.navigator.wheel(kCentre, 10.0, hand.now);
  hand.settle();
  EXPECT_DOUBLE_EQ(hand.navigator.camera().eye.height_m, 1.0);
  for (int i = 0; i < 40; ++i) hand.navigator.wheel({10.0, 10.0}, -10.0, hand.now);
  hand.settle();
  EXPECT_DOUBLE_EQ(hand.navigator.camera().eye.height_m, 50.0 * earth().ellipsoid.a_m());
}

// Without the stop the wheel goes down to 2.5 m over texels of 10 km: a flat blue screen.
TEST(Wheel, StopsAtTheFinestTexelsAndGoesOnAfterASecondPush) {
  constexpr double kTexel_m = 1.0e4;
  for (const bool by_key : {false, true}) {
    Hand hand(camera_at(46.0, 7.0, 1.0e7));
    hand.navigator.set_finest_texel(kTexel_m);
    const auto push = [&] {
      for (int i = 0; i < 60; ++i) {
        hand.now += Seconds(0.05);
        by_key ? hand.navigator.key(NavigationKey::zoom_in, hand.now) : hand.navigator.wheel(kCentre, 1.0, hand.now);
      }
      hand.settle();
    };
    const auto texel_px = [&] {
      const View view = make_view(hand.navigator.camera(), earth().ellipsoid, kViewport);
      return view.pixels_per_radian() * kTexel_m / hand.navigator.camera().eye.height_m;
    };
    push();
    EXPECT_NEAR(texel_px(), 8.0, 0.01);
    EXPECT_TRUE(hand.navigator.is_at_texels());
    hand.now += Seconds(1.0);
    push();
    EXPECT_GT(texel_px(), 1000.0) << "a second push goes on";
    EXPECT_FALSE(hand.navigator.is_at_texels());
  }
}

TEST(Wheel, OutFromATiltedViewKeepsTheGlobeInThePicture) {
  Hand hand(camera_at(46.0, 7.0, 1.0e4, 0.0, -5.0));
  for (int i = 0; i < 60; ++i) {
    hand.navigator.wheel(kCentre, -2.0, hand.now);
    hand.settle();
  }
  EXPECT_TRUE(project(make_view(hand.navigator.camera(), earth().ellipsoid, kViewport), Ecef{}).has_value());
  const glm::dvec2 middle = *project(make_view(hand.navigator.camera(), earth().ellipsoid, kViewport), Ecef{});
  EXPECT_GT(middle.y, 0.0);
  EXPECT_LT(middle.y, 768.0);
}

TEST(Pinch, KeepsThePointBetweenTheFingersAndIsThereAtOnce) {
  for (const Camera& start :
       {camera_at(46.0, 7.0, 3.0e6), camera_at(46.0, 179.9, 3.0e5, 30.0, -40.0), camera_at(89.0, 0.0, 4.0e6)}) {
    Hand hand(start);
    const glm::dvec2 px(650.0, 500.0);
    const Ecef held = hand.under(px);
    double height_m = start.eye.height_m;
    for (const double factor : {1.05, 1.2, 0.9, 2.0}) {
      hand.navigator.pinch(px, factor, hand.now += Seconds(kFrame_s));
      height_m /= factor;
      EXPECT_TRUE(hand.navigator.at_rest());
      EXPECT_LT(hand.miss_px(held, px), kHeld_px);
      EXPECT_NEAR(hand.navigator.camera().eye.height_m / height_m, 1.0, 1e-9);
    }
  }
}

TEST(Pinch, WithNonsenseOrAHeldButtonDoesNothing) {
  Hand hand(camera_at(46.0, 7.0, 1.0e6));
  for (const double factor : {0.0, -1.0, std::nan(""), HUGE_VAL}) hand.navigator.pinch(kCentre, factor, hand.now);
  EXPECT_EQ(hand.navigator.camera().eye.height_m, 1.0e6);
  hand.navigator.pointer_down(PointerButton::left, false, kCentre, hand.now);
  hand.navigator.pinch(kCentre, 2.0, hand.now);
  EXPECT_EQ(hand.navigator.camera().eye.height_m, 1.0e6);
}

}  // namespace
}  // namespace terrella::test
