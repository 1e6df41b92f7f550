#include "apps/flight/flight_path.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <string>
#include <vector>

#include "apps/film/film_plan.h"
#include "apps/flight/flight_file.h"

namespace terrella {
namespace {

// Rounding of angles and of exp(log(height)).
constexpr double kRounding = 1e-9;

FlightPath path_of(const std::string& coordinates, const std::string& properties) {
  const auto paths = parse_flight(R"({"type":"Feature","geometry":{"type":"LineString","coordinates":)" + coordinates +
                                      R"(},"properties":)" + properties + "}",
                                  "test");
  EXPECT_TRUE(paths) << (paths ? "" : paths.error().message);
  return paths->front();
}

std::string fault_of(const std::string& properties) {
  const auto paths = parse_flight(
      R"({"type":"Feature","geometry":{"type":"LineString","coordinates":[[0,0,1],[1,1,1]]},"properties":)" +
          properties + "}",
      "f.geojson");
  return paths ? "" : paths.error().message;
}

/// Radians a second over the ground.
glm::dvec3 velocity(const FlightPath& path, double time_s) {
  constexpr double kStep_s = 1e-4;
  return (eye_normal(path.at(time_s + kStep_s).camera) - eye_normal(path.at(time_s - kStep_s).camera)) /
         (2.0 * kStep_s);
}

TEST(FlightPath, SpeedAndDirectionHaveNoJumpsAtKeyframes) {
  const FlightPath path = path_of("[[0,0,1000],[10,0,5000],[12,9,2000],[12,9,2000],[-5,20,9000]]",
                                  R"({"times_s":[0,3,7,9,12],"headings":[0,90,40,40,10]})");
  for (const double time_s : {3.0, 7.0, 9.0}) {
    const glm::dvec3 before = velocity(path, time_s - 2e-4), after = velocity(path, time_s + 2e-4);
    EXPECT_LT(glm::length(after - before), 1e-3 * Angle::degrees(10.0).rad()) << time_s;
    const auto rate = [&](double at_s) {
      return log_height(path.at(at_s).camera) - log_height(path.at(at_s - 1e-4).camera);
    };
    EXPECT_NEAR(rate(time_s), rate(time_s + 1e-4), 1e-7) << time_s;
  }
  EXPECT_LT(glm::length(velocity(path, 8.0)), 1e-9);  // the eye rests
}

TEST(FlightPath, TwoKeyframesAreJoinedAsCameraBetweenDoes) {
  const FlightPath path = path_of("[[170,-20,1000],[-150,40,500000]]", R"({"duration_s":4})");
  for (const double t : {0.0, 0.2, 0.5, 0.9, 1.0}) {
    const Camera at = path.at(4.0 * t).camera;
    const Camera expected = camera_between(path.at(0.0).camera, path.at(4.0).camera, t);
    EXPECT_LT(glm::distance(eye_normal(at), eye_normal(expected)), kRounding);
    EXPECT_NEAR(at.eye.height_m / expected.eye.height_m, 1.0, kRounding);
  }
}

TEST(FlightPath, HeadingTurnsTheShorterWay) {
  const FlightPath path = path_of("[[0,0,1000],[1,0,1000]]", R"({"duration_s":2,"headings":[350,20]})");
  EXPECT_NEAR(std::remainder(path.at(1.0).camera.heading.deg() - 5.0, 360.0), 0.0, kRounding);
  const FlightPath back = path_of("[[179,0,1000],[-179,0,1000]]", R"({"duration_s":2,"headings":[-170,170]})");
  EXPECT_NEAR(std::abs(std::remainder(back.at(1.0).camera.heading.deg(), 360.0)), 180.0, kRounding);
  EXPECT_NEAR(std::abs(back.at(1.0).camera.eye.lon.deg()), 180.0, kRounding);  // the shorter way, too
}

/// The direction in which a camera that looks down has the upper side of its picture.
glm::dvec3 up_of(const Camera& camera) {
  const double lat = camera.eye.lat.rad(), lon = camera.eye.lon.rad(), heading = camera.heading.rad();
  const glm::dvec3 north{-std::sin(lat) * std::cos(lon), -std::sin(lat) * std::sin(lon), std::cos(lat)};
  const glm::dvec3 east{-std::sin(lon), std::cos(lon), 0.0};
  return std::cos(heading) * north + std::sin(heading) * east;
}

TEST(FlightPath, PictureDoesNotJumpOverAPole) {
  for (const char* headings : {"[0,180]", "[0,0]", "[90,-90]"}) {
    const FlightPath path =
        path_of("[[20,85,1e6],[-160,85,1e6]]", R"({"duration_s":2,"headings":)" + std::string(headings) + "}");
    for (int k = 0; k < 200; ++k) {
      const Camera a = path.at(0.01 * k).camera, b = path.at(0.01 * (k + 1)).camera;
      EXPECT_LT(glm::distance(up_of(a), up_of(b)), 0.03) << headings << k;
      EXPECT_NEAR(angle_between(eye_normal(a), eye_normal(b)).deg(), 0.05, 1e-6);
    }
  }
}

TEST(FlightPath, HeightsStayBetweenTheirKeyframes) {
  const double heights_m[] = {1000, 1000, 900000, 50, 40, 40, 2e7};
  const FlightPath path = path_of("[[0,0,1000],[1,0,1000],[2,0,900000],[3,0,50],[4,0,40],[5,0,40],[6,0,2e7]]",
                                  R"({"times_s":[0,1,1.5,4,9,9.2,20]})");
  for (std::size_t i = 0; i < 6; ++i) {
    for (int k = 0; k <= 100; ++k) {
      const double from_s = path.times()[i], to_s = path.times()[i + 1];
      const double height_m = path.at(from_s + (to_s - from_s) * k / 100.0).camera.eye.height_m;
      EXPECT_GE(height_m, std::min(heights_m[i], heights_m[i + 1]) * (1.0 - kRounding));
      EXPECT_LE(height_m, std::max(heights_m[i], heights_m[i + 1]) * (1.0 + kRounding));
    }
  }
}

TEST(FlightPath, TimeAndOpacityRunBetweenKeyframes) {
  const FlightPath path = path_of("[[0,0,1000],[1,0,1000]]",
                                  R"({"duration_s":10,"opacities":[1,0.5],"times":["2026-06-21","2026-06-22"]})");
  EXPECT_NEAR(path.at(5.0).surface_alpha.value_or(0.0), 0.75, kRounding);
  EXPECT_TRUE(path.at(5.0).sun == *parse_utc("2026-06-21T12:00Z"));
  EXPECT_FALSE(path_of("[[0,0,1000]]", "{}").at(0.0).sun);
}

TEST(FlightFile, FaultsAreNamed) {
  EXPECT_NE(fault_of(R"({"times_s":[2,2]})").find("does not ascend"), std::string::npos);
  EXPECT_NE(fault_of(R"({"times_s":[2]})").find("times_s is not an array of 2"), std::string::npos);
  EXPECT_NE(fault_of(R"({"times_s":[1,2],"duration_s":3})").find("one of them"), std::string::npos);
  EXPECT_NE(fault_of(R"({"pitch":5,"pitches":[1,2]})").find("pitch and pitches"), std::string::npos);
  EXPECT_NE(fault_of(R"({"headings":[1,400]})").find("headings[1] is not a number in -360...360"), std::string::npos);
  EXPECT_NE(fault_of(R"({"times":["2026-06-21","x"]})").find("times[1]"), std::string::npos);
  EXPECT_NE(fault_of(R"({"time":"1900-01-01"})").find("1950"), std::string::npos);
}

TEST(FilmPlan, FramesLastAsLongAsTheFlights) {
  const FlightPath a = path_of("[[0,0,1000],[1,0,1000]]", R"({"duration_s":2})");
  const FlightPath b = path_of("[[5,0,1000],[6,0,1000]]", R"({"duration_s":1})");
  const auto plan = FilmPlan::make({a, b}, 10.0);
  ASSERT_TRUE(plan);
  EXPECT_EQ(plan->frames(), 30);
  EXPECT_NEAR(plan->moment(10).camera.eye.lon.deg(), 0.5, kRounding);
  EXPECT_NEAR(plan->moment(20).camera.eye.lon.deg(), 5.0, kRounding);
  EXPECT_EQ(FilmPlan::make({path_of("[[0,0,1000]]", "{}")}, 30.0)->frames(), 1);
  EXPECT_FALSE(FilmPlan::make({path_of("[[0,0,1000],[1,0,1000]]", R"({"duration_s":1e6})")}, 30.0));
}

TEST(FilmPlan, MomentsLieEvenlyAroundTheirFrame) {
  const auto plan = FilmPlan::make({path_of("[[0,0,1000],[1,0,1000]]", R"({"duration_s":2})"),
                                    path_of("[[5,0,1000],[6,0,1000]]", R"({"duration_s":1})")},
                                   10.0);
  ASSERT_TRUE(plan);
  const auto lons = [&](std::int64_t frame, double shutter, int count) {
    std::vector<double> found;
    for (const FlightMoment& moment : plan->moments(frame, shutter, count))
      found.push_back(moment.camera.eye.lon.deg());
    return found;
  };
  // Half a degree a second: 0.1 s is 0.05°.
  const std::vector<double> open = lons(10, 0.8, 4);
  ASSERT_EQ(open.size(), 4U);
  for (int k = 0; k < 4; ++k) EXPECT_NEAR(open[std::size_t(k)], 0.5 + 0.05 * 0.8 * (k - 1.5) / 4.0, kRounding);
  EXPECT_EQ(lons(10, 0.0, 4), std::vector<double>{plan->moment(10).camera.eye.lon.deg()});
  EXPECT_NEAR(lons(0, 1.0, 2).front(), 0.0, kRounding);
  EXPECT_LT(lons(19, 1.0, 64).back(), 1.0 + kRounding);  // no moment shows the other flight
  EXPECT_GT(lons(20, 1.0, 64).front(), 5.0 - kRounding);
}

}  // namespace
}  // namespace terrella
