#include "view/flight.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "geo/body.h"
#include "view/ground_frame.h"

namespace terrella {
namespace {

Camera camera(double lat, double lon, double height_m, double heading = 0.0, double pitch = -90.0) {
  return {.eye = {.lat = Angle::degrees(lat), .lon = Angle::degrees(lon), .height_m = height_m},
          .heading = Angle::degrees(heading),
          .pitch = Angle::degrees(pitch)};
}

double degrees_apart(const glm::dvec3& a, const glm::dvec3& b) {
  return Angle::radians(std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b))).deg();
}

TEST(Ease, StartsAndEndsAtRest) {
  EXPECT_EQ(ease_in_out(-1.0), 0.0);
  EXPECT_EQ(ease_in_out(2.0), 1.0);
  EXPECT_DOUBLE_EQ(ease_in_out(0.5), 0.5);
  EXPECT_LT(ease_in_out(0.01), 1e-4);
  EXPECT_GT(ease_in_out(0.99), 1.0 - 1e-4);
}

TEST(Flight, EndsExactlyThere) {
  const Flight flight = plan_flight(camera(10, 20, 1e6), camera(12, 22, 1e5, 30, -50), earth().ellipsoid);
  EXPECT_EQ(flight_camera(flight, Seconds(-1.0)).eye.lat, flight.from.eye.lat);
  EXPECT_EQ(flight_camera(flight, flight.duration).eye.lat, flight.to.eye.lat);
  EXPECT_EQ(flight_camera(flight, Seconds(1e9)).pitch, flight.to.pitch);
  EXPECT_EQ(flight_camera(flight, Seconds(std::nan(""))).heading, flight.to.heading);
}

TEST(Flight, ClimbsOnALongWayAndNotOnAShortOne) {
  const Flight near = plan_flight(camera(10, 20, 1e6), camera(10.1, 20, 1e6), earth().ellipsoid);
  EXPECT_NEAR(flight_camera(near, 0.5 * near.duration).eye.height_m, 1e6, 1.0);
  const Flight far = plan_flight(camera(10, 20, 1e3), camera(60, 150, 1e3), earth().ellipsoid);
  EXPECT_GT(flight_camera(far, 0.5 * far.duration).eye.height_m, 1e6);
  EXPECT_LE(far.duration, Seconds(2.5));
}

// Every way to the antipode is as short as any other: one must be taken, all the way.
TEST(Flight, ToTheAntipodeTakesOneWay) {
  const Camera places[][2] = {{camera(0, 0, 3e6), camera(0, 180, 3e6)},
                              {camera(90, 0, 3e6), camera(-90, 0, 3e6)},
                              {camera(30, 40, 1e3, 20), camera(-30, -140, 1e3, 200)}};
  for (const auto& [from, to] : places) {
    const Flight flight = plan_flight(from, to, earth().ellipsoid);
    GroundFrame last = ground_frame(from);
    for (int i = 1; i <= 400; ++i) {
      const Camera now_at = flight_camera(flight, (i / 400.0) * flight.duration);
      ASSERT_TRUE(std::isfinite(now_at.eye.lat.rad() + now_at.eye.lon.rad() + now_at.eye.height_m)) << i;
      const GroundFrame now = ground_frame(now_at);
      EXPECT_LT(degrees_apart(last.up, now.up), 1.5) << i;  // half a turn in 400 eased steps: 0.85° at the fastest
      last = now;
    }
    EXPECT_LT(degrees_apart(last.up, ground_frame(to).up), 1e-9);
  }
}

TEST(Flight, OverThePoleAndTheAntimeridianIsSmooth) {
  const Flight flights[] = {plan_flight(camera(80, 0, 3e6), camera(80, 180, 3e6, 180), earth().ellipsoid),
                            plan_flight(camera(-10, 178, 3e6), camera(5, -175, 3e6), earth().ellipsoid)};
  for (const Flight& flight : flights) {
    GroundFrame last = ground_frame(flight.from);
    for (int i = 1; i <= 200; ++i) {
      const GroundFrame now = ground_frame(flight_camera(flight, (i / 200.0) * flight.duration));
      EXPECT_LT(degrees_apart(last.up, now.up), 0.3) << i;  // 20° in 200 eased steps: 0.19° at the fastest
      EXPECT_LT(degrees_apart(last.ahead, now.ahead), 0.3) << i;
      last = now;
    }
  }
}

TEST(GroundFrame, GoesThereAndBackEvenOnThePole) {
  for (const double lat : {-90.0, -33.0, 0.0, 89.9999, 90.0}) {
    const Camera c = camera(lat, 77.0, 100.0, -140.0, -30.0);
    const GroundFrame frame = ground_frame(c);
    const GroundFrame back = ground_frame(with_frame(c, frame_of(orientation(frame))));
    EXPECT_LT(degrees_apart(frame.up, back.up), 1e-7);  // 1 cm on Earth; a cosine keeps no more
    EXPECT_LT(degrees_apart(frame.ahead, back.ahead), 1e-7);
  }
}

}  // namespace
}  // namespace terrella
