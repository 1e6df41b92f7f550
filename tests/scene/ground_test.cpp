#include "view/ground.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <optional>

#include "relief_test_support.h"
#include "tests/scene/patch_test_support.h"

namespace terrella {
namespace {

using test::camera_at;
using test::Draw;
using test::WavyGround;

constexpr double kRoundTrip_px = 0.1;  // between a pixel and the place projected back
constexpr double kSameHit_m = 0.01;    // the truth is halved to a millimetre along the ray
constexpr Viewport kScreen{400, 300};

/// Distance at which a ray enters the ground, by the table: looked for every 500 m, or every 50,000th of the distance,
/// and then halved.
std::optional<double> dense_march_m(const WavyGround& truth, const Ecef& eye, const EcefDir& ray, double most_m) {
  const auto over_m = [&](double t) {
    const Geodetic at = truth.body().to_geodetic(Ecef{eye.xyz_m + t * ray.xyz});
    return at.height_m - truth.truth_m(at.lat.deg(), at.lon.deg());
  };
  const Ellipsoid shell(truth.body().a_m() + 1.02 * most_m, truth.body().f());
  const bool under = over_m(0.0) < 0.0;
  const double eye_height_m = truth.body().to_geodetic(eye).height_m;
  double last = 0.0;
  if (eye_height_m > 1.02 * most_m) {
    const auto enters = shell.intersect_m(eye, ray);
    if (!enters) return std::nullopt;
    last = *enters;
  }
  // From any side, all of a shell lies within a planet's diameter.
  const double end = last + 2.1 * truth.body().a_m();
  while (last < end) {
    const double next = last + std::max(500.0, last / 50000.0);
    if ((over_m(next) < 0.0) != under) {
      double before = last, behind = next;
      while (behind - before > 1e-3) {
        const double middle = 0.5 * (before + behind);
        ((over_m(middle) < 0.0) == under ? before : behind) = middle;
      }
      return 0.5 * (before + behind);
    }
    last = next;
  }
  return std::nullopt;
}

/// From high up, low and tilted, over a pole, on ±180°, along the ground, from far away.
std::vector<Camera> cameras(double most_m) {
  return {camera_at(20.0, 10.0, 8.0e6),
          camera_at(46.0, 7.0, 1.3 * most_m + 2000.0, 30.0, -8.0),
          camera_at(90.0, 0.0, 3.0e6, 15.0, -80.0),
          camera_at(-89.9, 45.0, 1.5 * most_m + 1.0e5, 200.0, -40.0),
          camera_at(5.0, 180.0, 6.0e5, 90.0, -35.0),
          camera_at(-30.0, -179.99, 4.0e5, 270.0, -15.0),
          camera_at(0.0, 60.0, 1.01 * most_m + 100.0, 120.0, -1.0),
          camera_at(10.0, -70.0, 1.0e8, 0.0, -90.0, 10.0)};
}

class GroundPicks : public testing::TestWithParam<double> {};

TEST_P(GroundPicks, FindWhatADenseMarchFinds) {
  constexpr double kMost_m = 9000.0;
  WavyGround wavy(kMost_m, GetParam(), 60);
  wavy.add_level(WavyGround::kLevel);
  const double most_m = kMost_m * GetParam();
  Draw draw(4);
  int hits = 0, slivers = 0;
  for (const Camera& camera : cameras(most_m)) {
    const View view = make_view(camera, wavy.body(), kScreen);
    for (int k = 0; k < 25; ++k) {
      const glm::dvec2 px(draw.between(0.0, 400.0), draw.between(0.0, 300.0));
      const EcefDir ray = pixel_ray(view, px);
      const auto truth_m = dense_march_m(wavy, view.eye, ray, most_m);
      const auto found_m = wavy.ground().intersect_m(view.eye, ray, 1.0 / view.pixels_per_radian());
      // A ridge that the ray cuts for less than a step, or a ray that only grazes one.
      if (truth_m.has_value() != found_m.has_value() || (truth_m && *found_m > *truth_m + kSameHit_m)) {
        ++slivers;
        continue;
      }
      if (!truth_m) continue;
      ++hits;
      EXPECT_NEAR(*found_m, *truth_m, kSameHit_m) << camera.eye.lat.deg() << " at " << px.x << ", " << px.y;
    }
  }
  EXPECT_GT(hits, 80);
  EXPECT_LE(slivers, 2);
}

TEST_P(GroundPicks, GoThereAndBackWithinATenthOfAPixelAllOverTheScreen) {
  constexpr double kMost_m = 9000.0;
  WavyGround wavy(kMost_m, GetParam(), 60);
  wavy.add_level(WavyGround::kLevel);
  for (const Camera& camera : cameras(kMost_m * GetParam())) {
    const View view = make_view(camera, wavy.body(), kScreen);
    int found = 0;
    for (double y = 0.5; y < 300.0; y += 13.0) {
      for (double x = 0.5; x < 400.0; x += 13.0) {
        const auto place = pick(view, wavy.ground(), {x, y});
        if (!place) continue;
        ++found;
        // The place's own height is the ground's: 1 mm for the way along the ray that is left.
        EXPECT_NEAR(place->height_m, wavy.ground().height_m(place->lat, place->lon), 1e-3 * GetParam());
        const auto back = project(view, wavy.ground(), place->lat, place->lon);
        ASSERT_TRUE(back);
        EXPECT_LT(glm::distance(*back, glm::dvec2(x, y)), kRoundTrip_px)
            << camera.eye.lat.deg() << " " << x << " " << y;
      }
    }
    EXPECT_GT(found, 60) << camera.eye.lat.deg();
  }
}

INSTANTIATE_TEST_SUITE_P(Exaggerations, GroundPicks, testing::Values(1.0, 20.0));

TEST(Ground, FromUnderneathTheGroundIsSeenFromBelow) {
  WavyGround wavy(9000.0, 20.0);
  wavy.add_level(WavyGround::kLevel);
  const double over_m = wavy.ground().height_m(Angle::degrees(5.0), Angle::degrees(3.0));
  ASSERT_GT(over_m, 5.0e4);
  for (const double height_m : {over_m - 10.0, 0.0, -5.0e5, -6.3e6}) {
    const Geodetic eye{.lat = Angle::degrees(5.0), .lon = Angle::degrees(3.0), .height_m = height_m};
    const auto up = wavy.ground().intersect_m(wavy.body().to_ecef(eye), Ellipsoid::normal(eye.lat, eye.lon));
    ASSERT_TRUE(up);
    EXPECT_NEAR(*up, over_m - height_m, kSameHit_m);
  }
}

TEST(Ground, WithoutReliefIsTheEllipsoid) {
  const Ellipsoid& body = earth().ellipsoid;
  const View view = make_view(camera_at(46.0, 7.0, 3.0e5, 20.0, -30.0), body, kScreen);
  const auto flat = pick(view, body, {200.5, 150.5});
  const auto place = pick(view, Ground(body), {200.5, 150.5});
  ASSERT_TRUE(flat && place);
  EXPECT_NEAR(place->lat.deg(), flat->lat.deg(), 1e-12);
  EXPECT_NEAR(place->height_m, 0.0, 1e-6);
  EXPECT_EQ(Ground(body).height_m(flat->lat, flat->lon), 0.0);
  EXPECT_FALSE(pick(view, Ground(body), {200.5, -5000.0}));
}

TEST(Ground, WhatIsNotFiniteMeetsNothing) {
  WavyGround wavy(9000.0, 5.0);
  wavy.add_level(0);
  const Ecef eye{{7.0e6, 0.0, 0.0}};
  EXPECT_FALSE(wavy.ground().intersect_m(Ecef{{std::nan(""), 0.0, 0.0}}, EcefDir{{1.0, 0.0, 0.0}}));
  EXPECT_FALSE(wavy.ground().intersect_m(eye, EcefDir{{HUGE_VAL, 0.0, 0.0}}));
  EXPECT_FALSE(wavy.ground().intersect_m(eye, EcefDir{{1.0, 0.0, 0.0}}));
}

}  // namespace
}  // namespace terrella
