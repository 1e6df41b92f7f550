#include "view/navigation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "geo/body.h"
#include "tests/scene/navigation_hand.h"
#include "tests/scene/patch_test_support.h"
#include "view/ground_frame.h"
#include "view/view_limits.h"

namespace terrella::test {
namespace {

struct DragCase {
  const char* what;
  Camera start;
  glm::dvec2 from, to;
  friend void PrintTo(const DragCase& one, std::ostream* out) { *out << one.what; }
};

class LeftDrag : public testing::TestWithParam<DragCase> {};

TEST_P(LeftDrag, HoldsTheGrabbedPointUnderTheCursor) {
  const DragCase& c = GetParam();
  Hand hand(c.start);
  const Ecef held = hand.under(c.from);
  hand.drag(c.from, c.to);
  EXPECT_LT(hand.miss_px(held, c.to), kHeld_px);
  EXPECT_TRUE(hand.navigator.at_rest());
  EXPECT_EQ(hand.navigator.camera().eye.height_m, c.start.eye.height_m);
  EXPECT_EQ(hand.navigator.camera().pitch, c.start.pitch);
}

INSTANTIATE_TEST_SUITE_P(
    Places, LeftDrag,
    testing::Values(
        DragCase{"mid_latitude", camera_at(46.0, 7.0, 3.0e6), {300.0, 300.0}, {700.0, 500.0}},
        DragCase{"across_the_antimeridian", camera_at(10.0, 179.5, 2.0e6), {700.0, 400.0}, {200.0, 380.0}},
        DragCase{"over_the_pole", camera_at(80.0, 30.0, 5.0e6), {500.0, 300.0}, {540.0, 600.0}},
        DragCase{"from_the_pole", camera_at(90.0, 0.0, 5.0e6), {512.0, 384.0}, {300.0, 200.0}},
        DragCase{"tilted_at_300_km", camera_at(46.0, 7.0, 3.0e5, 30.0, -35.0), {200.0, 600.0}, {800.0, 450.0}},
        DragCase{"two_metres_up", camera_at(-33.0, 151.0, 2.0, 200.0, -50.0), {512.0, 500.0}, {300.0, 600.0}},
        DragCase{"from_20_radii", camera_at(5.0, -60.0, 1.2e8), {512.0, 384.0}, {535.0, 370.0}}),
    [](const auto& test) { return std::string(test.param.what); });

TEST(Drag, GoesOverThePoleWithoutTurningThePicture) {
  Hand hand(camera_at(70.0, 30.0, 4.0e6));
  hand.navigator.pointer_down(PointerButton::left, false, {512.0, 100.0}, hand.now);
  glm::dvec3 last = ground_frame(hand.navigator.camera()).ahead;
  for (int y = 100; y <= 700; y += 5) {
    hand.now += Seconds(kFrame_s);
    hand.navigator.pointer_move({512.0, double(y)}, hand.now);
    const glm::dvec3 ahead = ground_frame(hand.navigator.camera()).ahead;
    EXPECT_GT(glm::dot(last, ahead), 0.99) << "the picture turned at " << y;  // under 8° in 5 px
    last = ahead;
  }
  EXPECT_NEAR(std::abs(hand.navigator.camera().heading.deg()), 180.0, 1e-6);  // the pole lies behind now
  EXPECT_NEAR(std::abs(hand.navigator.camera().eye.lon.deg()), 150.0, 1e-6);
}

TEST(Drag, OutAndBackNearThePoleEndsWhereItBegan) {
  Hand hand(camera_at(88.0, 10.0, 5.0e6, 25.0));
  const Camera start = hand.navigator.camera();
  hand.navigator.pointer_down(PointerButton::left, false, {400.0, 300.0}, hand.now);
  for (const glm::dvec2 px : {glm::dvec2(600.0, 300.0), glm::dvec2(600.0, 500.0), glm::dvec2(400.0, 300.0)}) {
    hand.navigator.pointer_move(px, hand.now += Seconds(0.2));
  }
  EXPECT_NEAR(hand.navigator.camera().eye.lat.deg(), start.eye.lat.deg(), kArrived_deg);
  EXPECT_NEAR(hand.navigator.camera().heading.deg(), start.heading.deg(), 1e-4);
}

TEST(Drag, KeepsTurningBesideTheGlobe) {
  Hand hand(camera_at(0.0, 0.0, 2.0e7));
  hand.navigator.pointer_down(PointerButton::left, false, kCentre, hand.now);
  double last = 0.0;
  for (double x = 552.0; x < 1400.0; x += 40.0) {
    hand.navigator.pointer_move({x, 384.0}, hand.now += Seconds(kFrame_s));
    EXPECT_LT(hand.navigator.camera().eye.lon.deg(), last) << x;
    last = hand.navigator.camera().eye.lon.deg();
  }
  EXPECT_GT(last, -180.0);
  EXPECT_NEAR(hand.navigator.camera().eye.lat.deg(), 0.0, kArrived_deg);
}

TEST(Glide, GoesOnInTheSameDirectionAndStops) {
  Hand hand(camera_at(20.0, 50.0, 4.0e6));
  hand.navigator.pointer_down(PointerButton::left, false, kCentre, hand.now);
  for (int i = 1; i <= 10; ++i) {
    hand.navigator.pointer_move(kCentre + glm::dvec2(12.0 * i, 0.0), hand.now += Seconds(kFrame_s));
  }
  hand.navigator.pointer_up(PointerButton::left, hand.now);
  ASSERT_TRUE(hand.navigator.animating());
  const Camera released = hand.navigator.camera();
  const Seconds took = hand.settle();
  EXPECT_LT(hand.navigator.camera().eye.lon.deg(), released.eye.lon.deg() - 1.0);
  EXPECT_NEAR(hand.navigator.camera().heading.deg(), 0.0, 1e-6);
  EXPECT_LT(took, Seconds(4.0));
}

TEST(Glide, IsAsFastWhenMovesComeInBundles) {
  // 600 px/s, once as 10 moves of 1/60 s and once as 3 frames of a slow program that gets several moves at one time.
  const auto glided_deg = [](int per_frame) {
    Hand hand(camera_at(0.0, 0.0, 3.0e6));
    hand.navigator.pointer_down(PointerButton::left, false, kCentre, hand.now);
    for (int i = 1; i <= 12; ++i) {
      if (i % per_frame == 0) hand.now += Seconds(per_frame * kFrame_s);
      hand.navigator.pointer_move(kCentre + glm::dvec2(10.0 * i, 0.0), hand.now + Seconds(1e-6 * i));
    }
    hand.navigator.pointer_up(PointerButton::left, hand.now + Seconds(1e-4));
    const double released_deg = hand.navigator.camera().eye.lon.deg();
    hand.settle();
    return released_deg - hand.navigator.camera().eye.lon.deg();
  };
  EXPECT_GT(glided_deg(1), 1.0);
  EXPECT_NEAR(glided_deg(4) / glided_deg(1), 1.0, 0.35);
}

TEST(Glide, DoesNotFollowFromAClickThatSlipped) {
  Hand hand(camera_at(20.0, 50.0, 4.0e6));
  hand.navigator.pointer_down(PointerButton::left, false, kCentre, hand.now);
  hand.navigator.pointer_move(kCentre + glm::dvec2(4.0, 2.0), hand.now += Seconds(kFrame_s));
  hand.navigator.pointer_up(PointerButton::left, hand.now);
  EXPECT_TRUE(hand.navigator.at_rest());
}

TEST(Glide, IsCaughtByAPress) {
  Hand hand(camera_at(20.0, 50.0, 4.0e6));
  hand.navigator.pointer_down(PointerButton::left, false, kCentre, hand.now);
  hand.navigator.pointer_move(kCentre + glm::dvec2(30.0, 0.0), hand.now += Seconds(kFrame_s));
  hand.navigator.pointer_up(PointerButton::left, hand.now);
  ASSERT_TRUE(hand.navigator.animating());
  hand.navigator.pointer_down(PointerButton::left, false, kCentre, hand.now);
  EXPECT_FALSE(hand.navigator.animating());
}

TEST(FlyTo, ArrivesWhereItWasToldOverAPoleToo) {
  for (const Camera& target : {camera_at(-33.9, 151.2, 2.0e4, 40.0, -50.0), camera_at(80.0, -173.0, 1.0e6)}) {
    Hand hand(camera_at(80.0, 7.0, 1.0e6));
    hand.navigator.fly_to(target, hand.now);
    EXPECT_TRUE(hand.navigator.animating());
    const Seconds took = hand.settle();
    EXPECT_GE(took.count(), 0.5);
    const Camera& there = hand.navigator.camera();
    EXPECT_NEAR(there.eye.lat.deg(), target.eye.lat.deg(), kArrived_deg);
    EXPECT_NEAR(there.eye.lon.deg(), target.eye.lon.deg(), kArrived_deg);
    EXPECT_NEAR(there.eye.height_m, target.eye.height_m, 0.1);
    EXPECT_NEAR(there.heading.deg(), target.heading.deg(), kArrived_deg);
  }
}

TEST(FlyTo, NowhereIsIgnored) {
  Hand hand(camera_at(80.0, 7.0, 1.0e6));
  hand.navigator.fly_to(camera_at(std::nan(""), 0.0, 1.0e6), hand.now);
  EXPECT_TRUE(hand.navigator.at_rest());
}

TEST(RightDrag, TiltsAndTurnsAroundThePictureCentre) {
  Hand hand(camera_at(46.0, 7.0, 3.0e5));
  const Ecef pivot = hand.under(kCentre);
  hand.drag({500.0, 500.0}, {600.0, 250.0}, PointerButton::right);
  EXPECT_LT(hand.miss_px(pivot, kCentre), kHeld_px);
  EXPECT_NEAR(hand.navigator.camera().pitch.deg(), -90.0 + 39.0, 3.0);  // less the globe's curve between eye and pivot
  EXPECT_NEAR(hand.navigator.camera().heading.deg(), 26.4, 1.5);
  const double distance =
      glm::distance(make_view(hand.navigator.camera(), earth().ellipsoid, kViewport).eye.xyz_m, pivot.xyz_m);
  EXPECT_NEAR(distance, 3.0e5, 1e-3);
}

TEST(RightDrag, IsTheSameAsLeftWithControl) {
  Hand right(camera_at(46.0, 7.0, 3.0e5, 80.0, -60.0));
  Hand left(camera_at(46.0, 7.0, 3.0e5, 80.0, -60.0));
  right.drag({500.0, 500.0}, {420.0, 450.0}, PointerButton::right);
  left.drag({500.0, 500.0}, {420.0, 450.0}, PointerButton::left, true);
  EXPECT_TRUE(right.navigator.camera() == left.navigator.camera());
  EXPECT_FALSE(right.navigator.camera() == camera_at(46.0, 7.0, 3.0e5, 80.0, -60.0));
}

TEST(RightDrag, StopsAboveTheGroundAndStraightDown) {
  Hand hand(camera_at(46.0, 7.0, 50.0));
  hand.drag({500.0, 700.0}, {500.0, -2000.0}, PointerButton::right);
  EXPECT_GE(hand.navigator.camera().eye.height_m, 1.0);
  EXPECT_GT(hand.navigator.camera().pitch.deg(), -5.0);
  hand.drag({500.0, 0.0}, {500.0, 3000.0}, PointerButton::right);
  EXPECT_NEAR(hand.navigator.camera().pitch.deg(), -90.0, kArrived_deg);
}

TEST(RightDrag, InTheSkyTurnsTheEyeInItsPlace) {
  Hand hand(camera_at(46.0, 7.0, 1000.0, 0.0, 10.0));
  hand.drag({500.0, 300.0}, {600.0, 400.0}, PointerButton::right);
  EXPECT_NEAR(hand.navigator.camera().eye.lat.deg(), 46.0, 1e-12);
  EXPECT_GT(hand.navigator.camera().heading.deg(), 20.0);
  EXPECT_LT(hand.navigator.camera().pitch.deg(), 0.0);
}

TEST(DoubleClick, FliesToThePoint) {
  Hand hand(camera_at(46.0, 179.0, 3.0e6, 40.0, -60.0));
  const Ecef there = hand.under({700.0, 500.0});
  hand.navigator.double_click({700.0, 500.0}, hand.now);
  EXPECT_TRUE(hand.navigator.animating());
  EXPECT_LT(hand.settle(), Seconds(3.0));
  EXPECT_LT(hand.miss_px(there, kCentre), kHeld_px);
  EXPECT_NEAR(hand.navigator.camera().eye.height_m, 1.2e6, 1.0);
}

TEST(DoubleClick, BesideTheGlobeDoesNothing) {
  Hand hand(camera_at(0.0, 0.0, 2.0e7));
  hand.navigator.double_click({2.0, 2.0}, hand.now);
  EXPECT_TRUE(hand.navigator.at_rest());
}

TEST(Keys, ArrowsMoveOverTheGlobe) {
  struct {
    NavigationKey key;
    double lat_sign, lon_sign;
  } const cases[] = {{NavigationKey::pan_up, 1.0, 0.0},
                     {NavigationKey::pan_down, -1.0, 0.0},
                     {NavigationKey::pan_left, 0.0, -1.0},
                     {NavigationKey::pan_right, 0.0, 1.0}};
  for (const auto& c : cases) {
    Hand hand(camera_at(0.0, 0.0, 3.0e6));
    const Ecef before = hand.under(kCentre);
    hand.navigator.key(c.key, hand.now);
    hand.settle();
    const Geodetic eye = hand.navigator.camera().eye;
    const glm::dvec2 travelled_px = 0.12 * 768.0 * glm::dvec2(-c.lon_sign, c.lat_sign);
    EXPECT_LT(hand.miss_px(before, kCentre + travelled_px), 1.5);  // centre by centre over the curved globe
    EXPECT_NEAR(std::abs(eye.lat.deg()) > 0.1 ? std::copysign(1.0, eye.lat.deg()) : 0.0, c.lat_sign, 0.0);
    EXPECT_NEAR(std::abs(eye.lon.deg()) > 0.1 ? std::copysign(1.0, eye.lon.deg()) : 0.0, c.lon_sign, 0.0);
  }
}

TEST(Keys, PlusAndMinusZoomAndCancelOut) {
  Hand hand(camera_at(46.0, 7.0, 3.0e6));
  hand.navigator.key(NavigationKey::zoom_in, hand.now);
  hand.settle();
  EXPECT_LT(hand.navigator.camera().eye.height_m, 2.5e6);
  hand.navigator.key(NavigationKey::zoom_out, hand.now);
  hand.settle();
  EXPECT_NEAR(hand.navigator.camera().eye.height_m, 3.0e6, 1.0);
}

TEST(Keys, NorthUpTurnsAroundThePictureCentre) {
  Hand hand(camera_at(46.0, 7.0, 3.0e5, 130.0, -45.0));
  const Ecef centre = hand.under(kCentre);
  hand.navigator.key(NavigationKey::north_up, hand.now);
  EXPECT_LT(hand.settle(), Seconds(1.0));
  EXPECT_NEAR(hand.navigator.camera().heading.deg(), 0.0, 0.01);
  EXPECT_LT(hand.miss_px(centre, kCentre), kHeld_px);
}

TEST(Keys, NorthUpTakesTheShortWayAndWorksOnThePole) {
  Hand hand(camera_at(10.0, 7.0, 3.0e5, -170.0));
  hand.navigator.key(NavigationKey::north_up, hand.now);
  hand.navigator.advance(hand.now += Seconds(0.2));
  hand.navigator.advance(hand.now += Seconds(0.1));
  EXPECT_LT(hand.navigator.camera().heading.deg(), -10.0);
  Hand pole(camera_at(90.0, 0.0, 3.0e6, 75.0));
  pole.navigator.key(NavigationKey::north_up, pole.now);
  pole.settle();
  EXPECT_NEAR(pole.navigator.camera().heading.deg(), 0.0, 0.01);
}

TEST(Keys, HomeShowsTheWholeGlobe) {
  Hand hand(camera_at(46.0, 7.0, 300.0, 130.0, 3.0));
  hand.navigator.key(NavigationKey::whole_globe, hand.now);
  hand.settle();
  EXPECT_DOUBLE_EQ(hand.navigator.camera().heading.deg(), 0.0);
  EXPECT_DOUBLE_EQ(hand.navigator.camera().pitch.deg(), -90.0);
  EXPECT_TRUE(hand.under({512.0, 100.0}).xyz_m.z > 0.0);
  const View view = make_view(hand.navigator.camera(), earth().ellipsoid, kViewport);
  EXPECT_FALSE(grab(view, earth().ellipsoid, {512.0, 20.0}).on_surface);
}

TEST(Robustness, EventsThatAreNotFiniteAreIgnored) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInf = std::numeric_limits<double>::infinity();
  Hand hand(camera_at(46.0, 7.0, 3.0e5));
  const Camera start = hand.navigator.camera();
  Navigator& n = hand.navigator;
  n.pointer_down(PointerButton::left, false, {kNan, 0.0}, hand.now);
  n.double_click({0.0, kInf}, hand.now);
  n.wheel(kCentre, kNan, hand.now);
  n.wheel(kCentre, kInf, hand.now);
  n.key(NavigationKey::pan_up, Seconds(kNan));
  n.advance(Seconds(kInf));
  EXPECT_TRUE(n.at_rest());
  n.pointer_down(PointerButton::left, false, kCentre, hand.now);
  n.pointer_move({kNan, kNan}, hand.now);
  n.pointer_move({520.0, 384.0}, Seconds(kNan));
  n.pointer_up(PointerButton::left, hand.now);
  EXPECT_TRUE(n.camera() == start);
  EXPECT_TRUE(n.at_rest());
}

TEST(Robustness, AClockThatJumpsMovesNothingFar) {
  Hand hand(camera_at(46.0, 7.0, 3.0e6));
  hand.navigator.double_click({600.0, 300.0}, hand.now);
  hand.navigator.advance(hand.now + Seconds(1.0e9));
  EXPECT_TRUE(hand.navigator.animating());
  EXPECT_GT(hand.navigator.camera().eye.height_m, 2.0e6);
  const Camera before = hand.navigator.camera();
  hand.navigator.advance(hand.now - Seconds(1.0e9));
  EXPECT_TRUE(hand.navigator.camera() == before);
  hand.settle();
  EXPECT_NEAR(hand.navigator.camera().eye.height_m, 1.2e6, 1.0);
}

TEST(Robustness, AClockThatStandsStillFlicksNoFasterThanTheLimit) {
  Hand hand(camera_at(0.0, 0.0, 3.0e6));
  hand.navigator.pointer_down(PointerButton::left, false, kCentre, hand.now);
  for (int i = 0; i < 50; ++i) hand.navigator.pointer_move(kCentre + glm::dvec2(i, 0.0), hand.now);
  hand.navigator.pointer_up(PointerButton::left, hand.now);
  EXPECT_LT(hand.settle(), Seconds(5.0));
}

TEST(Robustness, ADragToldAllAtOnceAfterASlowFrameGlidesAsIfItHadTakenThatFrame) {
  const auto glided_px = [](Seconds late) {
    Hand hand(camera_at(0.0, 0.0, 3.0e6));
    hand.navigator.pointer_down(PointerButton::left, false, kCentre, hand.now);
    for (int i = 0; i <= 100; ++i) hand.navigator.pointer_move(kCentre + glm::dvec2(i, 0.0), hand.now);
    const Angle dropped = hand.navigator.camera().eye.lon;
    const double px_deg = 100.0 / dropped.deg();
    hand.navigator.pointer_up(PointerButton::left, hand.now, late);
    EXPECT_LT(hand.settle(), Seconds(5.0));
    return px_deg * (hand.navigator.camera().eye.lon - dropped).deg();
  };
  constexpr double kDecay_s = 0.3;  // a glide goes as far as its first speed would in this time
  EXPECT_NEAR(glided_px(Seconds(0.4)), 100.0 * kDecay_s / 0.4, 5.0);
  EXPECT_NEAR(glided_px(Seconds(2.0)), 0.0, 1e-6);
}

TEST(Robustness, AOnePixelWindowAndACentreOfTheEarthCameraStayFinite) {
  for (const Viewport viewport : {Viewport{1, 1}, Viewport{16384, 16}, Viewport{0, -3}}) {
    for (const double height_m : {-6.378137e6, -10.0, 0.0, 1.0, 1.0e9}) {
      Navigator n(camera_at(90.0, 0.0, height_m, 10.0, -20.0), earth().ellipsoid, viewport);
      Seconds now(0.0);
      n.pointer_down(PointerButton::left, false, {0.5, 0.5}, now);
      n.pointer_move({40.0, -7.0}, now += Seconds(0.01));
      n.pointer_up(PointerButton::left, now);
      n.pointer_down(PointerButton::right, false, {0.5, 0.5}, now);
      n.pointer_move({40.0, -7.0}, now += Seconds(0.01));
      n.pointer_up(PointerButton::right, now);
      for (const NavigationKey key :
           {NavigationKey::pan_up, NavigationKey::zoom_out, NavigationKey::north_up, NavigationKey::whole_globe}) {
        n.key(key, now);
        for (int i = 0; i < 100; ++i) n.advance(now += Seconds(0.05));
      }
      const Camera& c = n.camera();
      EXPECT_TRUE(std::isfinite(c.eye.lat.rad() + c.eye.lon.rad() + c.eye.height_m + c.heading.rad() + c.pitch.rad()));
      EXPECT_TRUE(n.at_rest());
    }
  }
}

// The compass turns a tilted view back to a map of the same ground.
TEST(Keys, LookDownKeepsThePointAtTheCentre) {
  Hand hand(camera_at(46.0, 7.0, 3.0e5, 130.0, -40.0));
  const Ecef held = hand.under(kCentre);
  for (int time = 0; time < 2; ++time) {
    hand.navigator.key(NavigationKey::look_down, hand.now);
    hand.settle();
    EXPECT_NEAR(hand.navigator.camera().pitch.deg(), -90.0, 1e-9);
    EXPECT_NEAR(hand.navigator.camera().heading.deg(), 0.0, 1e-9);
    EXPECT_LT(hand.miss_px(held, kCentre), kHeld_px);
  }
}

TEST(Flights, CentreOnKeepsTheHeight) {
  Hand hand(camera_at(46.0, 7.0, 3.0e5));
  const Ecef held = hand.under({700.0, 300.0});
  hand.navigator.centre_on({700.0, 300.0}, hand.now);
  hand.settle();
  EXPECT_LT(hand.miss_px(held, kCentre), kHeld_px);
  EXPECT_NEAR(hand.navigator.camera().eye.height_m, 3.0e5, 1.0);
}

TEST(Led, LastsUntilTheUserMovesTheGlobe) {
  Hand hand(camera_at(46.0, 7.0, 3.0e5));
  Navigator& navigator = hand.navigator;
  for (const double lon : {8.0, 9.0}) {
    navigator.lead(camera_at(46.0, lon, 3.0e5));
    navigator.advance(hand.now += Seconds(kFrame_s));
    EXPECT_EQ(navigator.camera(), camera_at(46.0, lon, 3.0e5));
    EXPECT_TRUE(navigator.is_led() && navigator.animating() && !navigator.at_rest());
  }
  navigator.wheel(kCentre, 1.0, hand.now);
  EXPECT_FALSE(navigator.is_led());
  hand.settle();
  navigator.lead(camera_at(46.0, 7.0, 3.0e5));
  hand.drag({300.0, 300.0}, {400.0, 300.0});
  EXPECT_TRUE(!navigator.is_led() && navigator.at_rest());
  navigator.lead(camera_at(46.0, 7.0, 3.0e5));
  navigator.set_camera(camera_at(46.0, 7.0, 3.0e5));
  EXPECT_TRUE(!navigator.is_led() && navigator.at_rest());
}

}  // namespace
}  // namespace terrella::test
