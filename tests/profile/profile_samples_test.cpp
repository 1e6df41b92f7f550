// Samples of a profile: places along the measured path, and the table of them.
#include "apps/viewer/profile/profile_samples.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "geo/body.h"

namespace terrella {
namespace {

constexpr double kMillimetre_m = 1e-3;

Geodetic at(double lat_deg, double lon_deg) {
  return {.lat = Angle::degrees(lat_deg), .lon = Angle::degrees(lon_deg), .height_m = 0.0};
}

// Truth: great circles of a sphere of 6371 km.
TEST(ProfileSamples, LieAtEqualDistancesAlongAGreatCircle) {
  const Ellipsoid sphere(6371000.0, 0.0);
  const auto samples = profile_samples(sphere, std::vector{at(0, 170), at(0, -170)}, 10);
  ASSERT_EQ(samples.size(), 11U);
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const double turned_deg = 2.0 * static_cast<double>(k);
    EXPECT_NEAR(samples[k].along_m, 6371000.0 * turned_deg * M_PI / 180.0, kMillimetre_m);
    EXPECT_NEAR(samples[k].place.lat.deg(), 0.0, 1e-9);
    EXPECT_NEAR(std::remainder(samples[k].place.lon.deg() - 170.0 - turned_deg, 360.0), 0.0, 1e-9);
  }
}

TEST(ProfileSamples, HoldEveryPlaceOfThePath) {
  const std::vector<Geodetic> path{at(46, 7), at(46.001, 7.001), at(46.001, 7.001), at(47, 9)};
  const auto samples = profile_samples(earth().ellipsoid, path, 100);
  EXPECT_NEAR(static_cast<double>(samples.size()), 101.0, 2.0);
  for (const Geodetic& place : path) {
    EXPECT_TRUE(std::ranges::any_of(samples, [&](const ProfileSample& sample) {
      return std::abs(sample.place.lat.deg() - place.lat.deg()) < 1e-9 &&
             std::abs(sample.place.lon.deg() - place.lon.deg()) < 1e-9;
    }));
  }
  for (std::size_t k = 1; k < samples.size(); ++k) EXPECT_GT(samples[k].along_m, samples[k - 1].along_m);
}

TEST(ProfileSamples, NeedAWay) {
  EXPECT_TRUE(profile_samples(earth().ellipsoid, {}, 10).empty());
  EXPECT_TRUE(profile_samples(earth().ellipsoid, std::vector{at(1, 2)}, 10).empty());
  EXPECT_TRUE(profile_samples(earth().ellipsoid, std::vector{at(1, 2), at(1, 2)}, 10).empty());
}

TEST(ProfileSamples, AreATableWithEmptyFieldsForWhatIsNotKnown) {
  const std::vector<ProfileSample> samples{
      {.along_m = 0.0, .place = at(46.5, -7.25), .height_m = 1234.5, .value = {}},
      {.along_m = 1000.125, .place = at(46.5, 180.0), .height_m = {}, .value = 0.1}};
  EXPECT_EQ(profile_csv(samples),
            "distance_m,latitude,longitude,height_m,value\n0.000,46.500000000,-7.250000000,1234.5,\n"
            "1000.125,46.500000000,180.000000000,,0.1\n");
}

}  // namespace
}  // namespace terrella
