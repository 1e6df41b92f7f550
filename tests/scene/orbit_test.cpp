#include "view/orbit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "geo/body.h"

namespace terrella {
namespace {

// The line of sight and the ground's normal are then the same but for their last digits, and their product may come out
// over 1.
TEST(Orbit, OfAnEyeThatLooksStraightDownHasATilt) {
  constexpr double kRounding_rad = 1e-7;  // an angle whose sine is within a rounding of 1
  constexpr double kMovedPart = 1e-8;     // share of the distances: the eye is turned by that angle around the pivot
  std::mt19937_64 random(7);
  const auto between = [&random](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const Ellipsoid& e = earth().ellipsoid;
  for (int k = 0; k < 2000; ++k) {
    const Camera camera{.eye = {.lat = Angle::degrees(between(-90.0, 90.0)),
                                .lon = Angle::degrees(between(-180.0, 180.0)),
                                .height_m = std::pow(10.0, between(0.0, 8.0))},
                        .heading = Angle::degrees(between(0.0, 360.0))};
    const Orbit orbit = orbit_around(camera, e, e.to_ecef({.lat = camera.eye.lat, .lon = camera.eye.lon}));
    EXPECT_NEAR(orbit.depression.rad(), Angle::degrees(90.0).rad(), kRounding_rad) << k;
    const Camera back = orbit_camera(orbit, e, camera.fov_y);
    EXPECT_NEAR(back.eye.height_m, camera.eye.height_m, kMovedPart * (e.a_m() + camera.eye.height_m)) << k;
  }
}

}  // namespace
}  // namespace terrella
