#include "apps/bench/truth/spheroid.h"

#include <gtest/gtest.h>

#include <GeographicLib/Geocentric.hpp>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <random>

namespace terrella::truth {

inline void PrintTo(const Spheroid& body, std::ostream* out) { *out << body.a_m << " m"; }

namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kSurface = 5e-15;    // share of the radius: some twenty ulp, 3e-8 m on the Earth
constexpr double kAngle_deg = 1e-12;  // 1e-7 m on the ground: four orders under the smallest texel judged
constexpr double kGrazing = 2e-13;    // share of the radius: a ray that grazes amplifies the eye's own rounding

class SpheroidTest : public ::testing::TestWithParam<Spheroid> {
 protected:
  std::mt19937 engine_{7};
  static double surface_m() { return kSurface * GetParam().a_m; }
  double uniform(double low, double high) { return std::uniform_real_distribution<>(low, high)(engine_); }
};

TEST_P(SpheroidTest, PositionsAreGeographicLibs) {
  const GeographicLib::Geocentric reference(GetParam().a_m, GetParam().f);
  for (int i = 0; i < 2000; ++i) {
    const Place place{uniform(-90, 90), uniform(-180, 180), GetParam().a_m * uniform(-0.15, 1.5)};
    glm::dvec3 expected;
    reference.Forward(place.lat_deg, place.lon_deg, place.height_m, expected.x, expected.y, expected.z);
    EXPECT_LT(glm::distance(position_m(GetParam(), place), expected), surface_m()) << place.lat_deg;
  }
}

TEST_P(SpheroidTest, HitsLieOnTheSurfaceWhereGeographicLibPutsThem) {
  const GeographicLib::Geocentric reference(GetParam().a_m, GetParam().f);
  int hits = 0;
  for (int i = 0; i < 4000; ++i) {
    const Place eye{uniform(-90, 90), uniform(-180, 180), GetParam().a_m * std::pow(10.0, uniform(-5.5, 1.8))};
    const glm::dvec3 from = position_m(GetParam(), eye);
    const glm::dvec3 aim = GetParam().a_m * glm::dvec3(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
    const auto hit = first_hit(GetParam(), from, aim - from);
    if (!hit) continue;
    ++hits;
    double lat = 0, lon = 0, height = 0;
    reference.Reverse(hit->position_m.x, hit->position_m.y, hit->position_m.z, lat, lon, height);
    EXPECT_LT(std::abs(height), kGrazing * GetParam().a_m);
    EXPECT_NEAR(latitude_rad(hit->normal) / kDegree, lat, kAngle_deg);
    EXPECT_NEAR(longitude_rad(hit->normal) / kDegree, lon, kAngle_deg);
    EXPECT_LT(glm::dot(hit->normal, aim - from), 0.0) << "the near side faces the eye";
    const glm::dvec3 along = from + hit->distance * (aim - from);
    EXPECT_LT(glm::distance(along, hit->position_m), kGrazing * GetParam().a_m) << "the hit is on the ray";
  }
  EXPECT_GT(hits, 1000);
}

TEST_P(SpheroidTest, FromInsideTheFarWallIsSeen) {
  const auto hit = first_hit(GetParam(), {0, 0, 0}, {0, 0, 2.0});
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->position_m.z, GetParam().b_m(), surface_m());
  EXPECT_NEAR(hit->distance, 0.5 * GetParam().b_m(), surface_m());
}

TEST_P(SpheroidTest, WhatLiesBehindTheEyeIsNotHit) {
  const glm::dvec3 eye(2.0 * GetParam().a_m, 0, 0);
  EXPECT_FALSE(first_hit(GetParam(), eye, {1, 0, 0}));
  EXPECT_TRUE(first_hit(GetParam(), eye, {-1, 0, 0}));
}

INSTANTIATE_TEST_SUITE_P(Bodies, SpheroidTest,
                         ::testing::Values(Spheroid{}, Spheroid{6371000.0, 0.0}, Spheroid{60268000.0, 0.098},
                                           Spheroid{11267.0, 0.0}));

TEST(LocalFrameTest, IsRightHandedEastNorthUp) {
  const LocalFrame frame = local_frame(35.0, 120.0);
  EXPECT_LT(glm::distance(glm::cross(frame.east, frame.north), frame.up), kAngle_deg);
  EXPECT_GT(frame.north.z, 0.0);
  EXPECT_EQ(frame.east.z, 0.0);
}

}  // namespace
}  // namespace terrella::truth
