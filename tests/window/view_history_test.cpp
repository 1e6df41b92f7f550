#include "apps/viewer/tools/view_history.h"

#include <gtest/gtest.h>

#include "geo/body.h"

namespace terrella {
namespace {

Camera over(double lat_deg, double lon_deg, double height_m) {
  return {.eye = {.lat = Angle::degrees(lat_deg), .lon = Angle::degrees(lon_deg), .height_m = height_m}};
}

/// A camera that moves and rests while time passes.
struct Hand {
  ViewHistory history{earth().ellipsoid};
  Seconds now{0.0};
  void rest(const Camera& camera, double seconds) {
    history.follow(camera, true, now);
    now += Seconds(seconds);
    history.follow(camera, true, now);
  }
  void travel(const Camera& to) {
    history.follow(to, false, now += Seconds(0.1));
    rest(to, 1.0);
  }
};

TEST(ViewHistory, GoesBackAndForwardTwice) {
  Hand hand;
  const Camera a = over(0, 0, 1e6), b = over(10, 0, 1e6), c = over(20, 0, 1e6);
  hand.rest(a, 1.0);
  hand.travel(b);
  hand.travel(c);
  for (int time = 0; time < 2; ++time) {
    EXPECT_EQ(hand.history.back(), b);
    hand.travel(b);
    EXPECT_EQ(hand.history.back(), a);
    hand.travel(a);
    EXPECT_FALSE(hand.history.back());
    EXPECT_EQ(hand.history.forward(), b);
    hand.travel(b);
    EXPECT_EQ(hand.history.forward(), c);
    hand.travel(c);
    EXPECT_FALSE(hand.history.forward());
  }
  EXPECT_EQ(hand.history.size(), 3U);
}

TEST(ViewHistory, SmallMovesAndShortRestsAreNoViews) {
  Hand hand;
  const Camera a = over(0, 0, 1e6), near_a = over(0.5, 0, 1.1e6), passed = over(5, 0, 1e6), b = over(10, 0, 1e6);
  hand.rest(a, 1.0);
  hand.travel(near_a);
  hand.rest(passed, 0.3);
  hand.travel(b);
  EXPECT_EQ(hand.history.size(), 1U) << "the last view enters when the camera leaves it";
  EXPECT_EQ(hand.history.back(), near_a) << "where the user left the first view";
  EXPECT_EQ(hand.history.size(), 2U);
  EXPECT_EQ(hand.history.forward(), b);
}

TEST(ViewHistory, ANewViewDropsTheLaterOnes) {
  Hand hand;
  const Camera a = over(0, 0, 1e6), b = over(10, 0, 1e6), c = over(-10, 0, 1e6);
  hand.rest(a, 1.0);
  hand.travel(b);
  EXPECT_EQ(hand.history.back(), a);
  hand.travel(a);
  hand.travel(c);
  EXPECT_FALSE(hand.history.forward());
  EXPECT_EQ(hand.history.back(), a);
}

TEST(ViewHistory, AnotherViewIsMovedHigherTurnedOrTilted) {
  const Camera from = over(0, 0, 1e6);
  Camera turned = from, tilted = from, little = from;
  turned.heading = Angle::degrees(-20.0);
  tilted.pitch = Angle::degrees(-70.0);
  little.heading = Angle::degrees(355.0);
  const Ellipsoid body = earth().ellipsoid;
  EXPECT_TRUE(is_other_view(from, turned, body));
  EXPECT_TRUE(is_other_view(from, tilted, body));
  EXPECT_FALSE(is_other_view(from, little, body));
  EXPECT_TRUE(is_other_view(from, over(0, 0, 1.4e6), body));
  EXPECT_TRUE(is_other_view(from, over(0, 0, 7e5), body));
  EXPECT_TRUE(is_other_view(from, over(0, 0, -1e6), body));
  EXPECT_TRUE(is_other_view(over(0, 179.5, 1e5), over(0, -179.5, 1e5), body));
  EXPECT_FALSE(is_other_view(over(0, 179.99, 1e5), over(0, -179.99, 1e5), body));
}

}  // namespace
}  // namespace terrella
