// Longitudes go round: a rectangle's extent, and what meets it.
#include "geo/longitudes.h"

#include <gtest/gtest.h>

namespace terrella::test {
namespace {

GeoRect between(double west_deg, double east_deg) {
  return {.west = Angle::degrees(west_deg), .east = Angle::degrees(east_deg)};
}

TEST(Longitudes, CountEastwardFromTheWestSide) {
  EXPECT_NEAR(degrees_east(-170.0, 170.0), 20.0, 1e-12);
  EXPECT_NEAR(degrees_east(170.0, -170.0), 340.0, 1e-12);
  EXPECT_NEAR(degrees_east(550.0, 170.0), 20.0, 1e-12);
  EXPECT_EQ(degrees_east(5.0, 5.0), 0.0);
}

TEST(Longitudes, KnowHowWideARectangleIs) {
  EXPECT_NEAR(width_deg({}), 360.0, 1e-12);
  EXPECT_NEAR(width_deg(between(5.0, 17.0)), 12.0, 1e-12);
  EXPECT_NEAR(width_deg(between(170.0, -170.0)), 20.0, 1e-12);
  EXPECT_EQ(width_deg(between(5.0, 5.0)), 0.0);
}

TEST(Longitudes, MeetARectangle) {
  struct Case {
    GeoRect rect;
    double west_deg, wide_deg;
    bool meets;
  };
  const Case cases[] = {
      {between(5.0, 17.0), 10.0, 0.0, true},       // inside
      {between(5.0, 17.0), 18.0, 0.0, false},      // east of it
      {between(5.0, 17.0), 370.0, 0.0, true},      // inside, a turn further
      {between(5.0, 17.0), 0.0, 4.0, false},       // ends before it
      {between(5.0, 17.0), 0.0, 6.0, true},        // ends in it
      {between(5.0, 17.0), 0.0, 90.0, true},       // from one side over the other
      {between(170.0, -170.0), 180.0, 0.0, true},  // over the antimeridian
      {between(170.0, -170.0), -180.0, 0.0, true}, {between(170.0, -170.0), 0.0, 90.0, false},
      {between(170.0, -170.0), 160.0, 15.0, true}, {between(-180.0, 180.0), 180.0, 0.0, true},  // all of them
  };
  for (const Case& c : cases) {
    EXPECT_EQ(meets_longitudes(c.rect, c.west_deg, c.wide_deg), c.meets)
        << c.rect.west.deg() << ' ' << c.rect.east.deg() << ": " << c.west_deg << " + " << c.wide_deg;
  }
}

}  // namespace
}  // namespace terrella::test
