#include <gtest/gtest.h>

#include "geo/ellipsoid.h"
#include "geo_test_support.h"

namespace terrella {
namespace {

using test::Draw;
using test::kEpsilon;
using test::kInfinity;
using test::kNaN;

/// The textbook quadratic in 64-bit mantissas, by the plain formula: apart from the code under test, and with 11 bits
/// to spare for its cancellation.
struct Reference {
  long double near_m, far_m;    ///< NaN for a miss
  long double miss;             ///< 1 - |closest approach|² in units of the unit sphere
  long double origin_in_radii;  ///< the origin's distance from the centre there
};

Reference reference_crossings(const Ellipsoid& e, const Ecef& origin, const EcefDir& direction) {
  long double a = 0.0L;
  long double b = 0.0L;
  long double c = -1.0L;
  for (int axis = 0; axis < 3; ++axis) {
    const long double radius = axis == 2 ? (1.0L - e.f()) * e.a_m() : static_cast<long double>(e.a_m());
    const long double o = origin.xyz_m[axis] / radius;
    const long double d = direction.xyz[axis] / radius;
    a += d * d;
    b += o * d;
    c += o * o;
  }
  const long double root = std::sqrt(b * b - a * c);
  return {.near_m = (-b - root) / a,
          .far_m = (-b + root) / a,
          .miss = (b * b - a * c) / a,
          .origin_in_radii = std::sqrt(c + 1.0L)};
}

/// Error of the distance along the ray from the rounding of the closest approach (a few ulps of the origin's distance):
/// magnified by 1/sqrt(miss), as grazing incidence must.
double tolerance_m(const Ellipsoid& e, const Reference& r) {
  constexpr double roundings = 8.0;
  const double closest_error = roundings * kEpsilon * (static_cast<double>(r.origin_in_radii) + 1.0);
  return e.a_m() * closest_error * (1.0 + 1.0 / std::sqrt(static_cast<double>(r.miss)));
}

/// A ray from p to a point a given part of the body's radius away from its centre: 0 centre, 1 near the limb.
EcefDir aimed(Draw& draw, const Ellipsoid& e, const Ecef& p, double part) {
  const glm::dvec3 target = draw.direction().xyz * part * e.b_m();
  return EcefDir{glm::normalize(target - p.xyz_m)};
}

TEST(Ray, FromOutsideAgreesWithLongDouble) {
  Draw draw(11);
  int hits = 0;
  for (const Body& body : test::test_bodies()) {
    const Ellipsoid& e = body.ellipsoid;
    for (int k = 0; k < 2000; ++k) {
      const double height_m =
          e.a_m() * std::exp(draw.between(std::log(1e-7), std::log(157.0)));  // 1 m … 1e9 m on Earth
      const Ecef eye = e.position(draw.direction(), height_m);
      const EcefDir ray = aimed(draw, e, eye, draw.between(0.0, 1.2));
      const Reference expected = reference_crossings(e, eye, ray);
      const std::optional<double> found = e.intersect_m(eye, ray);
      const double doubtful = 64.0 * kEpsilon * static_cast<double>(expected.origin_in_radii + 1.0L);
      if (std::abs(static_cast<double>(expected.miss)) < doubtful) continue;
      const bool hit = expected.miss > 0.0L && expected.near_m > 0.0L;
      ASSERT_EQ(found.has_value(), hit) << body.name << ' ' << k;
      if (!hit) continue;
      ++hits;
      EXPECT_NEAR(*found, static_cast<double>(expected.near_m), tolerance_m(e, expected)) << body.name << ' ' << k;
    }
  }
  EXPECT_GT(hits, 8000);
}

TEST(Ray, FromInsideTakesTheFarWall) {
  Draw draw(12);
  for (const Body& body : test::test_bodies()) {
    const Ellipsoid& e = body.ellipsoid;
    for (int k = 0; k < 500; ++k) {
      const Ecef eye{draw.direction().xyz * draw.between(0.0, 0.99) * e.b_m()};
      const EcefDir ray = draw.direction();
      const Reference expected = reference_crossings(e, eye, ray);
      const std::optional<double> found = e.intersect_m(eye, ray);
      ASSERT_TRUE(found.has_value()) << body.name << ' ' << k;
      EXPECT_NEAR(*found, static_cast<double>(expected.far_m), tolerance_m(e, expected)) << body.name << ' ' << k;
    }
    EXPECT_NEAR(*e.intersect_m(Ecef{}, {{0, 0, -1}}), e.b_m(), 4.0 * kEpsilon * e.a_m()) << body.name;
    EXPECT_NEAR(*e.intersect_m(Ecef{}, {{0, 1, 0}}), e.a_m(), 4.0 * kEpsilon * e.a_m()) << body.name;
  }
}

TEST(Ray, GrazingHitLiesOnTheSurface) {
  Draw draw(13);
  const Ellipsoid& e = earth().ellipsoid;
  for (const double eye_height_m : {1.0, 1e3, 1e6, 1e9}) {
    for (int k = 0; k < 500; ++k) {
      // Aimed at a point that lies a hair under the surface, along the surface there; the eye itself is over it.
      const EcefDir n = draw.direction();
      const EcefDir along{glm::normalize(glm::cross(n.xyz, draw.direction().xyz))};
      const double depth_m = std::exp(draw.between(std::log(1e-3), std::log(0.5)));
      const double back_m = std::sqrt(2.0 * e.a_m() * eye_height_m) + eye_height_m;
      const Ecef eye{e.position(n, -depth_m).xyz_m - back_m * along.xyz};
      const std::optional<double> found = e.intersect_m(eye, along);
      // An ulp of the eye's coordinates is where the ray's line itself is uncertain.
      const double line_error_m = 16.0 * kEpsilon * (e.a_m() + back_m);
      if (!found) {
        EXPECT_LT(depth_m, line_error_m) << eye_height_m << ' ' << k;
        continue;
      }
      const Ecef hit{eye.xyz_m + *found * along.xyz};
      EXPECT_NEAR(e.to_geodetic(hit).height_m, 0.0, line_error_m) << eye_height_m << ' ' << k;
      // 1 mm deep the ray meets the ground at 1.7e-5 rad; 4 µm of line error are 3e-8 rad of that.
      EXPECT_LT(glm::dot(e.surface_normal(hit).xyz, along.xyz), -1e-5) << "the near crossing faces the eye";
    }
  }
}

TEST(Ray, OneMetreUpStraightDown) {
  Draw draw(14);
  for (int k = 0; k < 200; ++k) {
    const EcefDir n = draw.direction();
    const std::optional<double> found = earth().ellipsoid.intersect_m(earth().ellipsoid.position(n, 1.0), {-n.xyz});
    ASSERT_TRUE(found.has_value());
    EXPECT_NEAR(*found, 1.0, 4e-9);  // 4 ulps of Earth's radius, 0.93 nm each
  }
}

TEST(Ray, JustOverAndJustUnderTheSurfaceTheDistanceIsNeverNegative) {
  Draw draw(15);
  const Ellipsoid& e = earth().ellipsoid;
  for (int k = 0; k < 20000; ++k) {
    const EcefDir n = draw.direction();
    const double height_m = std::exp(draw.between(std::log(1e-10), std::log(1e-8)));
    const EcefDir slanted{glm::normalize(n.xyz + glm::cross(n.xyz, draw.direction().xyz))};
    for (const double side : {1.0, -1.0}) {  // over the surface looking down, under it looking up
      const std::optional<double> found = e.intersect_m(e.position(n, side * height_m), {-side * slanted.xyz});
      if (!found) continue;  // within an ulp of the surface the eye's side of it is chance
      EXPECT_GE(*found, 0.0) << k << ' ' << side * height_m;
    }
  }
}

TEST(Ray, MissesAndSurfacesBehind) {
  const Ellipsoid& e = earth().ellipsoid;
  const Ecef eye{{1e9, 0, 0}};
  EXPECT_TRUE(e.intersect_m(eye, {{-1, 0, 0}}).has_value());
  EXPECT_FALSE(e.intersect_m(eye, {{1, 0, 0}}).has_value());
  EXPECT_FALSE(e.intersect_m(eye, {{0, 1, 0}}).has_value());
  EXPECT_FALSE(e.intersect_m(eye, {{0, 0, 0}}).has_value());
  EXPECT_FALSE(e.intersect_m(Ecef{{e.a_m() + 1e-3, 0, 0}}, {{0, 0, 1}}).has_value());
}

TEST(Ray, FromTheSurfaceItself) {
  const Ellipsoid unit(1.0, 0.0);
  EXPECT_EQ(unit.intersect_m(Ecef{{1, 0, 0}}, {{-1, 0, 0}}), 0.0);
  EXPECT_EQ(unit.intersect_m(Ecef{{1, 0, 0}}, {{0, 1, 0}}), 0.0);
  EXPECT_FALSE(unit.intersect_m(Ecef{{1, 0, 0}}, {{1, 0, 0}}).has_value());
}

TEST(Ray, WhatIsNotFiniteHitsNothing) {
  const Ellipsoid& e = earth().ellipsoid;
  for (const double bad : {kNaN, kInfinity, -kInfinity}) {
    EXPECT_FALSE(e.intersect_m(Ecef{{bad, 0, 0}}, {{-1, 0, 0}}).has_value());
    EXPECT_FALSE(e.intersect_m(Ecef{{1e7, 0, 0}}, {{bad, 0, 0}}).has_value());
    EXPECT_FALSE(e.intersect_m(Ecef{}, {{0, 0, bad}}).has_value());
  }
}

}  // namespace
}  // namespace terrella
