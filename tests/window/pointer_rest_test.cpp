#include "apps/viewer/balloon/pointer_rest.h"

#include <gtest/gtest.h>

namespace terrella {
namespace {

const Seconds kMoment = PointerRest::kMoment + Seconds(0.001);
const glm::dvec2 kHere(3.0, 4.0), kThere(3.0, 5.0);

TEST(PointerRest, IsToldOnceAfterAMoment) {
  PointerRest rest;
  rest.follow(kHere, Seconds(1.0));
  EXPECT_FALSE(rest.take(Seconds(1.0)));
  EXPECT_NEAR(rest.seconds_left(Seconds(1.1), 9.0), kMoment.count() - 0.1, 0.002);
  rest.follow(kHere, Seconds(1.0) + kMoment);
  EXPECT_TRUE(rest.is_due(Seconds(1.0) + kMoment));
  EXPECT_EQ(rest.take(Seconds(1.0) + kMoment), kHere);
  EXPECT_TRUE(rest.is_told());
  EXPECT_FALSE(rest.take(Seconds(9.0)));
  EXPECT_EQ(rest.seconds_left(Seconds(9.0), 7.0), 7.0) << "nothing to wait for";
}

TEST(PointerRest, BeginsAnewWithEachMove) {
  PointerRest rest;
  rest.follow(kHere, Seconds(1.0));
  rest.follow(kThere, Seconds(1.3));
  EXPECT_FALSE(rest.take(Seconds(1.6)));
  EXPECT_EQ(rest.take(Seconds(1.3) + kMoment), kThere);
  rest.follow(kHere, Seconds(2.0));
  EXPECT_FALSE(rest.is_told());
  EXPECT_EQ(rest.take(Seconds(2.0) + kMoment), kHere);
}

TEST(PointerRest, DoesNotRestElsewhereOrWhenItIsHushed) {
  PointerRest rest;
  rest.follow(std::nullopt, Seconds(1.0));
  EXPECT_FALSE(rest.take(Seconds(9.0)));
  rest.follow(kHere, Seconds(9.0));
  rest.hush();
  EXPECT_FALSE(rest.take(Seconds(19.0)));
}

}  // namespace
}  // namespace terrella
