// Sun, Moon and stars against ephemerides in print, and against what everyone saw.
#include "sky/almanac.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "geo/ellipsoid.h"

namespace terrella::test {
namespace {

// Stricter than what almanac.h promises: how UTC differs from UT1 does not show here, and moon98 is at its worst in
// none of these rows. The nutation of greenwich_deg() is good to 0.0003°.
constexpr double kPlace_deg = 0.002;
constexpr double kMoonDistance_m = 20e3;
constexpr double kNutation_deg = 0.005;  // the most by which true places differ from mean ones
constexpr double kAstronomicalUnit_m = 1.495978707e11;

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

double sin_deg(double deg) { return std::sin(deg * std::numbers::pi / 180.0); }

/// Right ascension of Greenwich, true equinox: Meeus (12.4), and the two largest terms of nutation of his chapter 22.
double greenwich_deg(std::string_view utc) {
  using namespace std::chrono;
  constexpr UtcTime j2000 = sys_days{year{2000} / January / 1} + hours{12};
  const double d = duration<double, days::period>(*parse_utc(utc) - j2000).count();
  const double nutation_arcsec = -17.20 * sin_deg(125.04452 - 0.0529538 * d) - 1.32 * sin_deg(560.9330 + 1.9712947 * d);
  return 280.46061837 + 360.98564736629 * d + nutation_arcsec / 3600.0 * 0.9175;
}

TEST(Almanac, TestsMeasureFromTheRightGreenwich) {  // Meeus, example 12.a: apparent sidereal time 13h10m46.1351s
  EXPECT_NEAR(std::remainder(greenwich_deg("1987-04-10T00:00:00Z") - 15.0 * (13 + 10 / 60.0 + 46.1351 / 3600.0), 360.0),
              0.0, 2e-4);
}

/// The direction in ECEF axes of an apparent place, true equator and equinox of date.
glm::dvec3 seen(std::string_view utc, double right_ascension_deg, double declination_deg) {
  return over(declination_deg, right_ascension_deg - greenwich_deg(utc));
}

constexpr double hms(int h, int m, double s) { return 15.0 * (h + m / 60.0 + s / 3600.0); }
constexpr double dms(int d, int m, double s) { return d + m / 60.0 + s / 3600.0; }

/// Apparent geocentric places in print. UTC is the printed Terrestrial Time less 32.184 s and the leap seconds of then.
struct SunRow {
  const char* utc;
  double ra_deg, dec_deg;
};
struct MoonRow {
  const char* utc;
  double ra_deg, dec_deg, parallax_deg;  // parallax of the equator's radius
};

// F. Espenak, NASA/GSFC, eclipse.gsfc.nasa.gov: Sun and Moon at greatest eclipse, by JPL's DE200/LE200 (1999, 2002,
// 2005) or VSOP87 and ELP2000 (1954, 2008, 2045).
constexpr SunRow kSuns[] = {
    {"1954-06-30T12:32:05.4Z", hms(6, 35, 35.5), dms(23, 11, 36.6)},
    {"1999-08-11T11:03:04.8Z", hms(9, 23, 8.297), dms(15, 19, 39.72)},
    {"2002-12-04T07:31:11.5Z", hms(16, 41, 50.939), -dms(22, 13, 29.20)},
    {"2005-04-08T20:35:46.3Z", hms(1, 10, 30.278), dms(7, 28, 47.25)},
    {"2008-02-07T03:55:05.3Z", hms(21, 20, 44.7), -dms(15, 30, 56.1)},
    {"2045-08-12T17:41:29.3Z", hms(9, 31, 17.8), dms(14, 40, 40.5)},
    // Meeus, example 25.b, by VSOP87.
    {"1992-10-12T23:59:00.8Z", hms(13, 13, 30.749), -dms(7, 47, 1.74)},
    // Reda and Andreas, Solar Position Algorithm, NREL/TP-560-34302, table A5.1.
    {"2003-10-17T19:30:32.8Z", 202.22741, -9.31434},
};
constexpr MoonRow kMoons[] = {
    {"1954-06-30T12:32:05.4Z", hms(6, 36, 0.5), dms(23, 47, 16.6), dms(0, 59, 2.1)},
    {"1999-08-11T11:03:04.8Z", hms(9, 23, 34.531), dms(15, 48, 38.51), dms(0, 58, 44.24)},
    {"2002-12-04T07:31:11.5Z", hms(16, 41, 32.881), -dms(22, 31, 5.17), dms(1, 0, 2.27)},
    {"2005-04-08T20:35:46.3Z", hms(1, 11, 8.328), dms(7, 10, 59.27), dms(0, 58, 8.96)},
    {"2008-02-07T03:55:05.3Z", hms(21, 22, 15.3), -dms(16, 21, 0.4), dms(0, 57, 12.3)},
    {"2045-08-12T17:41:29.3Z", hms(9, 31, 39.7), dms(14, 52, 30.2), dms(1, 1, 22.3)},
    // Meeus, example 47.a, waxing: 368409.7 km.
    {"1992-04-11T23:59:00.8Z", 134.688470, 13.768368, 0.9919896},
    // USNO, NOVAS C 3.1, sample calculations, waning, by JPL's DE405: 0.002710296515 au.
    {"2008-04-24T10:36:18.0Z", 15.0 * 17.1390774264, -27.5374448870, 0.9013473},
};

TEST(Almanac, PutsTheSunWherePrintedEphemeridesDo) {
  for (const SunRow& row : kSuns) {
    EXPECT_LE(apart_deg(at(row.utc).sun.xyz, seen(row.utc, row.ra_deg, row.dec_deg)), kPlace_deg) << row.utc;
    EXPECT_NEAR(glm::length(at(row.utc).sun.xyz), 1.0, 1e-12);
  }
  EXPECT_NEAR(at("1992-10-12T23:59:00.8Z").sun_distance_m / kAstronomicalUnit_m, 0.99760853, 1e-6);
  EXPECT_NEAR(at("2003-10-17T19:30:32.8Z").sun_distance_m / kAstronomicalUnit_m, 0.9965422974, 1e-6);
}

TEST(Almanac, PutsTheMoonWherePrintedEphemeridesDo) {
  constexpr double kEquator_m = 6378137.0;
  for (const MoonRow& row : kMoons) {
    SCOPED_TRACE(row.utc);
    const glm::dvec3 moon = at(row.utc).moon.xyz_m;
    EXPECT_LE(apart_deg(moon, seen(row.utc, row.ra_deg, row.dec_deg)), kPlace_deg);
    EXPECT_NEAR(glm::length(moon), kEquator_m / sin_deg(row.parallax_deg), kMoonDistance_m);
  }
}

TEST(Almanac, KnowsEquinoxesAndSolstices) {
  EXPECT_NEAR(declination_deg(at("2024-03-20T03:06:00Z").sun.xyz), 0.0, kPlace_deg);
  EXPECT_NEAR(declination_deg(at("2024-09-22T12:44:00Z").sun.xyz), 0.0, kPlace_deg);
  EXPECT_NEAR(declination_deg(at("2026-06-21T08:24:00Z").sun.xyz), 23.436, kNutation_deg);
  EXPECT_NEAR(declination_deg(at("2026-12-21T20:50:00Z").sun.xyz), -23.436, kNutation_deg);
}

TEST(Almanac, HasTheEclipses) {
  // Total along a path from Mexico to Newfoundland: at the Earth's centre the discs then nearly touch.
  constexpr double kEclipse_deg = 0.6;
  const Almanac solar = at("2024-04-08T18:17:00Z");
  EXPECT_LT(apart_deg(solar.sun.xyz, solar.moon.xyz_m), kEclipse_deg);
  EXPECT_LT(apart_deg(at("1999-08-11T11:03:00Z").sun.xyz, at("1999-08-11T11:03:00Z").moon.xyz_m), kEclipse_deg);
  const Almanac lunar = at("2025-03-14T06:59:00Z");
  EXPECT_GT(apart_deg(lunar.sun.xyz, lunar.moon.xyz_m), 180.0 - kEclipse_deg);
  // Place under the axis of the shadow at that minute: 25.3°N 104.1°W.
  const Ecef nazas = Ellipsoid(6378137.0, 1.0 / 298.257223563)
                         .to_ecef({.lat = Angle::degrees(25.29), .lon = Angle::degrees(-104.15), .height_m = 0.0});
  EXPECT_LE(apart_deg(solar.sun.xyz, solar.moon.xyz_m - nazas.xyz_m), 2.0 * kPlace_deg);
}

// Meeus, chapter 21, example b and exercise: mean places, without the nutation (at most 0.005°) that the sky has.
TEST(Almanac, TurnsTheStars) {
  struct StarRow {
    const char* utc;
    double j2000_ra_deg, j2000_dec_deg;  // with the star's own motion
    double ra_deg, dec_deg;
  };
  constexpr StarRow rows[] = {
      {"2028-11-13T04:33:36Z", 41.054063, 49.227750, 41.547214, 49.348483},  // theta Persei
      {"2050-01-01T00:00:00Z", hms(2, 31, 58.643), dms(89, 15, 50.14), hms(3, 48, 16.43),
       dms(89, 27, 15.38)},  // Polaris
  };
  for (const StarRow& row : rows) {
    const glm::dvec3 ecef = at(row.utc).ecef_from_j2000 * over(row.j2000_dec_deg, row.j2000_ra_deg);
    EXPECT_LE(apart_deg(ecef, seen(row.utc, row.ra_deg, row.dec_deg)), kPlace_deg + kNutation_deg) << row.utc;
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
