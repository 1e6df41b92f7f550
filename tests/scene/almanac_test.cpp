// Sun, Moon and stars against an independent ephemeris, against Meeus' worked examples, and against what everyone saw.
#include "scene/almanac.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "geo/ellipsoid.h"

namespace terrella::test {
namespace {

// What almanac.h promises.
constexpr double kSun_deg = 0.02;
constexpr double kMoon_deg = 0.04;
constexpr double kMoonDistance_m = 150e3;
constexpr double kStar_deg = 0.02;
constexpr double kSidereal_deg = 1e-4;  // the formula's own; that UTC is not UT1 is the rest of the promise

Almanac at(std::string_view text) {
  const auto time = parse_utc(text);
  EXPECT_TRUE(time) << text;
  const auto almanac = almanac_at(*time);
  EXPECT_TRUE(almanac) << text;
  return *almanac;
}

double apart_deg(const glm::dvec3& a, const glm::dvec3& b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)) * 180.0 / std::numbers::pi;
}

glm::dvec3 over(double lat_deg, double lon_deg) {
  return Ellipsoid::normal(Angle::degrees(lat_deg), Angle::degrees(lon_deg)).xyz;
}

double declination_deg(const glm::dvec3& direction) {
  return std::asin(glm::normalize(direction).z) * 180.0 / std::numbers::pi;
}

/// Where Sun and Moon stand overhead on a sphere: latitude, longitude; from IAU's SOFA models as ERFA 2.0 computes them
/// (epv00 with aberration, moon98, c2t06a with UT1 = UTC).
struct Row {
  const char* time;
  double sun_lat, sun_lon, sun_au;
  double moon_lat, moon_lon, moon_km;
  double sidereal_deg;
};
constexpr Row kRows[] = {
    {"1955-01-01T00:00:00Z", -23.08341, -179.21650, 0.983291, 4.38460, -102.97749, 377207.2, 99.86780},
    {"1978-07-29T18:45:00Z", 18.70290, -99.65005, 1.015235, 16.99373, -160.54310, 401596.8, 228.31158},
    {"1987-04-10T19:21:00Z", 7.96824, -109.90524, 1.001893, 10.22287, 34.17292, 392535.4, 128.73789},
    {"1999-08-11T11:03:00Z", 15.32772, 15.56339, 1.013579, 15.81097, 15.67217, 373317.3, 125.22403},
    {"2010-12-05T06:00:00Z", -22.35489, 87.61697, 0.985542, -23.72038, 80.69947, 377185.2, 163.93285},
    {"2024-04-08T18:17:00Z", 7.59141, -93.84207, 1.001507, 7.89709, -94.00968, 359804.5, 111.74693},
    {"2025-03-14T06:59:00Z", -2.40461, 77.53839, 0.994195, 2.68070, -102.30490, 401507.7, 276.90296},
    {"2026-06-21T12:00:00Z", 23.43785, 0.45432, 1.016203, 0.04948, 85.10839, 386061.5, 89.69937},
    {"2049-09-17T03:30:00Z", 2.10495, 126.12031, 1.005192, 20.84150, 13.14459, 391325.3, 49.01083},
};

TEST(Almanac, AgreesWithAnIndependentEphemeris) {
  for (const Row& row : kRows) {
    SCOPED_TRACE(row.time);
    const Almanac a = at(row.time);
    EXPECT_NEAR(glm::length(a.sun.xyz), 1.0, 1e-12);
    EXPECT_LE(apart_deg(a.sun.xyz, over(row.sun_lat, row.sun_lon)), kSun_deg);
    EXPECT_NEAR(a.sun_distance_m / 1.495978707e11, row.sun_au, 1e-4);
    EXPECT_LE(apart_deg(a.moon.xyz_m, over(row.moon_lat, row.moon_lon)), kMoon_deg);
    EXPECT_NEAR(glm::length(a.moon.xyz_m), row.moon_km * 1e3, kMoonDistance_m);
    EXPECT_NEAR(a.sidereal.deg(), row.sidereal_deg, kSidereal_deg);
  }
}

// The examples are in dynamical time, 59 s ahead of UTC in 1992.
TEST(Almanac, AgreesWithTheExamplesInMeeus) {
  const Almanac sun = at("1992-10-12T23:59:01Z");  // 25.a
  EXPECT_NEAR(declination_deg(sun.sun.xyz), -7.78507, kSun_deg);
  EXPECT_NEAR(sun.sun_distance_m / 1.495978707e11, 0.99766, 1e-5);
  const double right_ascension =
      std::atan2(sun.sun.xyz.y, sun.sun.xyz.x) * 180.0 / std::numbers::pi + sun.sidereal.deg();
  EXPECT_NEAR(std::remainder(right_ascension - 198.38083, 360.0), 0.0, kSun_deg);
  const Almanac moon = at("1992-04-11T23:59:01Z");  // 47.a
  EXPECT_NEAR(declination_deg(moon.moon.xyz_m), 13.768368, kMoon_deg);
  EXPECT_NEAR(glm::length(moon.moon.xyz_m), 368409.7e3, kMoonDistance_m);
}

TEST(Almanac, KnowsEquinoxesAndSolstices) {
  EXPECT_NEAR(declination_deg(at("2024-03-20T03:06:00Z").sun.xyz), 0.0, kSun_deg);
  EXPECT_NEAR(declination_deg(at("2024-09-22T12:44:00Z").sun.xyz), 0.0, kSun_deg);
  EXPECT_NEAR(declination_deg(at("2026-06-21T08:24:00Z").sun.xyz), 23.436, kSun_deg);
  EXPECT_NEAR(declination_deg(at("2026-12-21T20:50:00Z").sun.xyz), -23.436, kSun_deg);
}

TEST(Almanac, HasTheEclipses) {
  // Total along a path from Mexico to Newfoundland: at the Earth's centre the discs then nearly touch.
  constexpr double kEclipse_deg = 0.6;
  const Almanac solar = at("2024-04-08T18:17:00Z");
  EXPECT_LT(apart_deg(solar.sun.xyz, solar.moon.xyz_m), kEclipse_deg);
  EXPECT_LT(apart_deg(at("1999-08-11T11:03:00Z").sun.xyz, at("1999-08-11T11:03:00Z").moon.xyz_m), kEclipse_deg);
  const Almanac lunar = at("2025-03-14T06:59:00Z");
  EXPECT_GT(apart_deg(lunar.sun.xyz, lunar.moon.xyz_m), 180.0 - kEclipse_deg);
  // Where the shadow's axis met the Earth at that minute: 25.3°N 104.1°W.
  const Ecef nazas = Ellipsoid(6378137.0, 1.0 / 298.257223563)
                         .to_ecef({.lat = Angle::degrees(25.29), .lon = Angle::degrees(-104.15), .height_m = 0.0});
  EXPECT_LE(apart_deg(solar.sun.xyz, solar.moon.xyz_m - nazas.xyz_m), kMoon_deg + kSun_deg);
}

TEST(Almanac, TurnsTheStars) {
  struct StarRow {
    const char* time;
    double ra_deg, dec_deg;  // J2000
    double lat_deg, lon_deg;
  };
  // ERFA 2.0, c2t06a.
  constexpr StarRow rows[] = {
      {"1950-01-01T00:00:00Z", 101.2872, -16.7161, -16.66060, 0.65290},
      {"2026-06-21T12:00:00Z", 101.2872, -16.7161, -16.74339, 11.88318},
      {"2050-12-31T23:00:00Z", 101.2872, -16.7161, -16.77542, 16.29083},
      {"1950-01-01T00:00:00Z", 37.9546, 89.2641, 89.02938, -72.97121},
      {"2026-06-21T12:00:00Z", 37.9546, 89.2641, 89.37552, -43.13597},
      {"2050-12-31T23:00:00Z", 279.2347, 38.7837, 38.83264, -165.90368},
  };
  for (const StarRow& row : rows) {
    const glm::dvec3 ecef = at(row.time).ecef_from_j2000 * over(row.dec_deg, row.ra_deg);
    EXPECT_LE(apart_deg(ecef, over(row.lat_deg, row.lon_deg)), kStar_deg) << row.time << ' ' << row.ra_deg;
  }
}

TEST(Almanac, SaysWhichYearsItKnows) {
  EXPECT_TRUE(almanac_at(*parse_utc("1950-01-01")));
  EXPECT_TRUE(almanac_at(*parse_utc("2050-12-31T23:59:59Z")));
  for (const char* text : {"1949-12-31T23:59:59Z", "2051-01-01T00:00:00Z", "0001-01-01", "9999-12-31"}) {
    const auto almanac = almanac_at(*parse_utc(text));
    ASSERT_FALSE(almanac) << text;
    EXPECT_NE(almanac.error().message.find("from 1950 to 2050"), std::string::npos) << almanac.error().message;
  }
}

TEST(UtcTime, IsReadFromIso8601) {
  using namespace std::chrono;
  const UtcTime noon = sys_days{year{2026} / June / 21} + hours{12};
  for (const char* text :
       {"2026-06-21T12:00:00Z", "2026-06-21T12:00Z", "2026-06-21 12:00:00", "2026-06-21T12:00:00.0Z"}) {
    const auto read = parse_utc(text);
    ASSERT_TRUE(read) << text;
    EXPECT_EQ(*read, noon) << text;
  }
  EXPECT_EQ(*parse_utc("2026-06-21"), noon - hours{12});
  EXPECT_EQ(*parse_utc("2026-06-21T12:00:00.25Z"), noon + milliseconds{250});
  EXPECT_EQ(*parse_utc("2024-02-29T00:00Z"), UtcTime(sys_days{year{2024} / February / 29}));
}

TEST(UtcTime, RefusesWhatIsNone) {
  for (const char* text : {"",
                           "now",
                           "2026",
                           "2026-06",
                           "2026-6-21",
                           "+026-06-21",
                           "2026-13-01",
                           "2026-02-29",
                           "2026-06-31",
                           "0000-01-01",
                           "2026-06-21Z",
                           "2026-06-21T",
                           "2026-06-21T24:00:00Z",
                           "2026-06-21T12:60:00Z",
                           "2026-06-30T23:59:60Z",
                           "2026-06-21T12:00:00+02:00",
                           "2026-06-21T12:00:00.Z",
                           "2026-06-21T12:00:00.2.5Z",
                           "2026-06-21T12:00:00.2e1Z",
                           "2026-06-21T12:00:00ZZ",
                           "2026-06-21T12:00:00 UTC",
                           "21.06.2026",
                           "2026/06/21"}) {
    const auto read = parse_utc(text);
    ASSERT_FALSE(read) << text;
    EXPECT_NE(read.error().message.find("2026-06-21T12:00:00Z"), std::string::npos) << read.error().message;
  }
}

}  // namespace
}  // namespace terrella::test
