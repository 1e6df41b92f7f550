#include "geo/measure.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "geo/body.h"

namespace terrella {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kNanometres_m = 2.0e-8;

Geodetic at(double lat_deg, double lon_deg) {
  return {.lat = Angle::degrees(lat_deg), .lon = Angle::degrees(lon_deg), .height_m = 0.0};
}

TEST(Measure, DistancesAreThoseOfTheBooks) {
  const Ellipsoid earth_ = earth().ellipsoid;
  // A quarter of the equator, and of a meridian: 10001965.729 m on WGS 84 (Karney 2013, section 2).
  EXPECT_NEAR(geodesic_m(earth_, at(0, 0), at(0, 90)), 0.5 * kPi * 6378137.0, kNanometres_m);
  EXPECT_NEAR(geodesic_m(earth_, at(0, 12), at(90, 0)), 10001965.729, 0.0005);
  EXPECT_EQ(geodesic_m(earth_, at(46, 7), at(46, 7)), 0.0);
  // Nearly antipodal, where series of the kind of Vincenty's do not end.
  EXPECT_NEAR(geodesic_m(earth_, at(0, 0), at(0.5, 179.5)), 19936288.579, 0.0005);
}

TEST(Measure, OverTheAntimeridianAndAPoleIsTheShortWay) {
  const Ellipsoid earth_ = earth().ellipsoid;
  EXPECT_NEAR(geodesic_m(earth_, at(0, 179), at(0, -179)), 2.0 * kPi / 180.0 * 6378137.0, kNanometres_m);
  EXPECT_NEAR(geodesic_m(earth_, at(89, 0), at(89, 180)), 2.0 * geodesic_m(earth_, at(89, 0), at(90, 0)),
              kNanometres_m);
}

TEST(Measure, OfTheFlattestPlanetToo) {
  const Ellipsoid flat(6378137.0, 0.098);
  // A quarter of an ellipse by its arithmetic-geometric series, summed here.
  double perimeter = 0.0;
  constexpr int kSteps = 20000;
  for (int k = 0; k < kSteps; ++k) {
    const double t = (k + 0.5) * 0.5 * kPi / kSteps;
    perimeter += std::hypot(flat.a_m() * std::sin(t), flat.b_m() * std::cos(t)) * 0.5 * kPi / kSteps;
  }
  EXPECT_NEAR(geodesic_m(flat, at(0, 0), at(90, 0)), perimeter, 0.001);
}

TEST(Measure, PlacesOnAWayAreEvenlySpaced) {
  const Ellipsoid earth_ = earth().ellipsoid;
  Geodetic from = at(40, 170), to = at(-10, -120);
  from.height_m = 100.0;
  const std::vector<Geodetic> places = geodesic_places(earth_, from, to, 5);
  ASSERT_EQ(places.size(), 5U);
  const double whole_m = geodesic_m(earth_, from, to);
  for (std::size_t k = 1; k < places.size(); ++k) {
    EXPECT_NEAR(geodesic_m(earth_, places[k - 1], places[k]), 0.25 * whole_m, 1e-6);
    EXPECT_NEAR(geodesic_m(earth_, from, places[k]), 0.25 * double(k) * whole_m, 1e-6) << "on the shortest way";
  }
  EXPECT_EQ(places[2].height_m, 50.0);
}

TEST(Measure, PathsAreSumsOfTheirParts) {
  const Ellipsoid earth_ = earth().ellipsoid;
  const std::vector<Geodetic> places = {at(0, 0), at(0, 10), at(0, 40)};
  EXPECT_NEAR(path_m(earth_, places), 40.0 * kPi / 180.0 * 6378137.0, kNanometres_m);
  EXPECT_EQ(path_m(earth_, {}), 0.0);
  EXPECT_EQ(path_m(earth_, std::vector{at(3, 4)}), 0.0);
}

TEST(Measure, AreasWhicheverWayRoundAndWhereverTheyLie) {
  const Ellipsoid sphere(1.0e6, 0.0);
  constexpr double kRounding = 1e-12;
  const double octant = 0.5 * kPi * 1.0e12;
  for (const double turn : {0.0, 100.0, 170.0, -179.0}) {
    const std::vector<Geodetic> ring = {at(0, turn), at(0, turn + 90.0), at(90, 0)};
    const std::vector<Geodetic> other = {ring[2], ring[1], ring[0]};
    EXPECT_NEAR(polygon_measure(sphere, ring).area_m2 / octant, 1.0, kRounding);
    EXPECT_NEAR(polygon_measure(sphere, other).area_m2 / octant, 1.0, kRounding);
    EXPECT_NEAR(polygon_measure(sphere, ring).perimeter_m / (1.5 * kPi * 1.0e6), 1.0, kRounding);
  }
  // Around a pole: a cap in many pieces.
  std::vector<Geodetic> cap;
  for (int k = 0; k < 3600; ++k) cap.push_back(at(-60.0, 0.1 * k));
  const double cap_m2 = 2.0 * kPi * 1.0e12 * (1.0 - std::sin(kPi / 3.0));
  constexpr double kPiecesAreStraight = 1e-5;
  EXPECT_NEAR(polygon_measure(sphere, cap).area_m2 / cap_m2, 1.0, kPiecesAreStraight);
  EXPECT_EQ(polygon_measure(sphere, std::vector{at(0, 0), at(0, 10)}).area_m2, 0.0);
}

}  // namespace
}  // namespace terrella
