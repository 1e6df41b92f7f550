#include "geo/ellipsoid.h"

#include <gtest/gtest.h>

#include <GeographicLib/Geocentric.hpp>
#include <numbers>

#include "geo_test_support.h"

namespace terrella {
namespace {

using test::Draw;
using test::kEpsilon;
using test::kInfinity;
using test::kNaN;

// A position is three products and sums of numbers up to a + h: a few roundings of that size.
constexpr double kForwardUlps = 8.0;
// The header's 10 nm on Earth; GeographicLib states 7 nm within 5000 km. Rounding grows with the body.
constexpr double kInverseErrorPerAxis = 1.0e-8 / 6378137.0;
constexpr double kHalfTurnRad = std::numbers::pi;

Geodetic random_place(Draw& draw, double lowest_m, double highest_m) {
  return {.lat = Angle::degrees(draw.between(-90.0, 90.0)),
          .lon = Angle::degrees(draw.between(-180.0, 180.0)),
          .height_m = draw.between(lowest_m, highest_m)};
}

TEST(Ellipsoid, ForwardAgreesWithGeographicLib) {
  Draw draw(1);
  for (const Body& body : test::test_bodies()) {
    const Ellipsoid& e = body.ellipsoid;
    const GeographicLib::Geocentric reference(e.a_m(), e.f());
    for (int k = 0; k < 500; ++k) {
      const Geodetic place = random_place(draw, -0.5 * e.b_m(), 10.0 * e.a_m());
      glm::dvec3 expected;
      reference.Forward(place.lat.deg(), place.lon.deg(), place.height_m, expected.x, expected.y, expected.z);
      const double tolerance_m = kForwardUlps * kEpsilon * (e.a_m() + std::abs(place.height_m));
      EXPECT_LE(glm::distance(e.to_ecef(place).xyz_m, expected), tolerance_m) << body.name << ' ' << k;
    }
  }
}

TEST(Ellipsoid, GeodeticComesBackWithinTenNanometres) {
  Draw draw(2);
  for (const Body& body : test::test_bodies()) {
    const Ellipsoid& e = body.ellipsoid;
    const double reach_m = 0.78 * e.a_m();  // 5000 km on Earth
    for (int k = 0; k < 500; ++k) {
      const Geodetic place = random_place(draw, -0.5 * reach_m, reach_m);
      const Geodetic back = e.to_geodetic(e.to_ecef(place));
      const double tolerance_m = kInverseErrorPerAxis * e.a_m();
      EXPECT_LE(glm::distance(e.to_ecef(back).xyz_m, e.to_ecef(place).xyz_m), tolerance_m) << body.name << ' ' << k;
      EXPECT_NEAR(back.height_m, place.height_m, tolerance_m) << body.name << ' ' << k;
      EXPECT_NEAR(back.lat.rad(), place.lat.rad(), 2.0 * kInverseErrorPerAxis) << body.name << ' ' << k;
    }
  }
}

TEST(Ellipsoid, PublishedPointOfGeographicLib) {
  // GeographicLib's example-Geocentric: Mount Everest's 27.99°N 86.93°E 8820 m, printed there to the metre.
  const Geodetic everest{.lat = Angle::degrees(27.99), .lon = Angle::degrees(86.93), .height_m = 8820.0};
  constexpr double printed_to_m = 1.0;
  EXPECT_LE(glm::distance(earth().ellipsoid.to_ecef(everest).xyz_m, glm::dvec3(302271.4, 5635928.4, 2979666.1)),
            printed_to_m);
}

TEST(Ellipsoid, CurvatureRadiiAtEquatorAndPole) {
  for (const Body& body : test::test_bodies()) {
    const Ellipsoid& e = body.ellipsoid;
    EXPECT_DOUBLE_EQ(e.prime_vertical_radius_m(0.0), e.a_m()) << body.name;
    EXPECT_NEAR(e.prime_vertical_radius_m(1.0), e.a_m() * e.a_m() / e.b_m(), 4.0 * kEpsilon * e.a_m() / (1.0 - e.f()))
        << body.name;
    EXPECT_NEAR(e.position({{0, 0, -1}}, 0.0).xyz_m.z, -e.b_m(), 4.0 * kEpsilon * e.a_m()) << body.name;
  }
}

TEST(Ellipsoid, PolesAndAxis) {
  for (const Body& body : test::test_bodies()) {
    const Ellipsoid& e = body.ellipsoid;
    for (const double side : {1.0, -1.0}) {
      for (const double zero : {0.0, -0.0}) {
        const Geodetic above = e.to_geodetic(Ecef{{zero, zero, side * 2.0 * e.b_m()}});
        EXPECT_EQ(above.lat.deg(), side * 90.0) << body.name;
        EXPECT_EQ(above.lon.rad(), 0.0) << body.name;
        EXPECT_NEAR(above.height_m, e.b_m(), 4.0 * kEpsilon * e.a_m()) << body.name;
        EXPECT_EQ(Ellipsoid::lat_lon({{zero, zero, side}}).lon.rad(), 0.0);
      }
    }
    const Geodetic centre = e.to_geodetic(Ecef{{-0.0, -0.0, -0.0}});
    EXPECT_EQ(centre.lat.deg(), 90.0) << body.name;
    EXPECT_EQ(centre.lon.rad(), 0.0) << body.name;
    EXPECT_NEAR(centre.height_m, -e.b_m(), 4.0 * kEpsilon * e.a_m()) << body.name;
  }
}

TEST(Ellipsoid, EquatorialPlaneNearTheAxisHasTheNorthernAnswer) {
  const Ellipsoid saturn = parse_body("saturn")->ellipsoid;
  for (const double zero : {0.0, -0.0}) {
    const Geodetic inside = saturn.to_geodetic(Ecef{{0.0, 0.5 * saturn.e2() * saturn.a_m(), zero}});
    EXPECT_GT(inside.lat.deg(), 0.0);
    EXPECT_EQ(inside.lon.deg(), 90.0);
    EXPECT_LT(inside.height_m, 0.0);
  }
  EXPECT_EQ(saturn.to_geodetic(Ecef{{saturn.a_m(), 0.0, 0.0}}).lat.deg(), 0.0);
}

TEST(Ellipsoid, AntipodesMirror) {
  Draw draw(3);
  for (const Body& body : test::test_bodies()) {
    for (int k = 0; k < 100; ++k) {
      const Ecef p{draw.direction().xyz * 1.3 * body.ellipsoid.a_m()};
      const Geodetic here = body.ellipsoid.to_geodetic(p);
      const Geodetic there = body.ellipsoid.to_geodetic(Ecef{-p.xyz_m});
      EXPECT_EQ(there.lat.rad(), -here.lat.rad()) << body.name;
      EXPECT_EQ(there.height_m, here.height_m) << body.name;
      // The half turn is rounded once.
      EXPECT_NEAR(std::abs((there.lon - here.lon).rad()), kHalfTurnRad, 4.0 * kEpsilon) << body.name;
    }
  }
}

TEST(Ellipsoid, AntimeridianIsPlus180) {
  for (const double y : {0.0, -0.0, -1e-320, -1e-300}) {
    EXPECT_EQ(Ellipsoid::lat_lon({{-1.0, y, 0.0}}).lon.rad(), kHalfTurnRad) << y;
    EXPECT_EQ(earth().ellipsoid.to_geodetic(Ecef{{-7e6, y, 0.0}}).lon.rad(), kHalfTurnRad) << y;
  }
  EXPECT_EQ(Ellipsoid::lat_lon(Ellipsoid::normal({}, Angle::degrees(-180.0))).lon.deg(), 180.0);
  EXPECT_LT(Ellipsoid::lat_lon({{-1.0, -1e-12, 0.0}}).lon.deg(), -179.0);
}

TEST(Ellipsoid, NormalIsExactAtPolesAndAccurateBesideThem) {
  for (const double lon : {0.0, 45.0, 180.0, -120.0}) {
    const EcefDir north = Ellipsoid::normal(Angle::degrees(90.0), Angle::degrees(lon));
    EXPECT_EQ(north.xyz.z, 1.0);
    EXPECT_LE(std::hypot(north.xyz.x, north.xyz.y), kEpsilon);
    EXPECT_EQ(Ellipsoid::lat_lon(north).lat.deg(), 90.0);
  }
  // 1 µm from Earth's pole is a colatitude of 1.6e-13; asin would answer 0 or 1.5e-8.
  const double colatitude = 1.6e-13;
  const Geodetic beside = Ellipsoid::lat_lon({{0.0, -colatitude, 1.0}});
  EXPECT_NEAR(kHalfTurnRad / 2.0 - beside.lat.rad(), colatitude, kEpsilon);
  EXPECT_EQ(beside.lon.deg(), -90.0);
}

TEST(Ellipsoid, SurfaceNormalInvertsPosition) {
  Draw draw(4);
  for (const Body& body : test::test_bodies()) {
    for (int k = 0; k < 200; ++k) {
      const EcefDir n = draw.direction();
      // Four roundings; the flattest body's 1/(1-e²) magnifies them by 2.
      EXPECT_LE(glm::distance(body.ellipsoid.surface_normal(body.ellipsoid.position(n)).xyz, n.xyz), 8.0 * kEpsilon)
          << body.name;
    }
  }
}

TEST(Ellipsoid, WhatIsNotFiniteGivesNaN) {
  for (const double bad : {kNaN, kInfinity, -kInfinity}) {
    for (int axis = 0; axis < 3; ++axis) {
      glm::dvec3 p(1e6);
      p[axis] = bad;
      const Geodetic nowhere = earth().ellipsoid.to_geodetic(Ecef{p});
      EXPECT_TRUE(std::isnan(nowhere.lat.rad()) && std::isnan(nowhere.lon.rad()) && std::isnan(nowhere.height_m));
    }
    EXPECT_TRUE(std::isnan(earth().ellipsoid.to_ecef({.lat = Angle::degrees(bad), .lon = {}}).xyz_m.z));
    EXPECT_TRUE(std::isnan(Ellipsoid(bad, 0.0).to_geodetic(Ecef{{1, 2, 3}}).lat.rad()));
    EXPECT_TRUE(std::isnan(Ellipsoid(1.0, bad).to_geodetic(Ecef{{1, 2, 3}}).lat.rad()));
  }
  EXPECT_TRUE(std::isnan(Ellipsoid::lat_lon({{kNaN, 0, 0}}).lat.rad()));
}

TEST(Angle, WholeQuartersAreExact) {
  for (const double quarter : {-180.0, -90.0, 0.0, 90.0, 180.0, 360.0}) {
    EXPECT_EQ(Angle::degrees(quarter).deg(), quarter);
    EXPECT_EQ(Angle::degrees(quarter).rad(), quarter / 180.0 * kHalfTurnRad);
  }
}

}  // namespace
}  // namespace terrella
