#include "view/surface_pin.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <optional>
#include <random>

#include "geo/body.h"
#include "tests/scene/patch_test_support.h"

namespace terrella {
namespace {

using test::camera_at;

// Error that pin() promises: far below the resolution of a hand or a screen.
constexpr double kPinned_px = 0.01;
// Cosine of the incidence angle under which a pixel is a hundred times longer than wide; there the limb is what one
// holds.
constexpr double kGrazing = 0.01;
constexpr Viewport kPinViewport{1024, 768};

bool grazing(const View& view, const Ellipsoid& ellipsoid, const Ecef& point) {
  const glm::dvec3 to_eye = glm::normalize(view.eye.xyz_m - point.xyz_m);
  return glm::dot(to_eye, ellipsoid.surface_normal(point).xyz) < kGrazing;
}

double miss_px(const Camera& c, const Ellipsoid& ellipsoid, const Ecef& point, glm::dvec2 px) {
  const auto seen = project(make_view(c, ellipsoid, kPinViewport), point);
  return seen ? glm::distance(*seen, px) : HUGE_VAL;
}

/// Pins what is under `from` to `to` and returns how far off it is then; nothing if either is beside the globe.
std::optional<double> drag_miss_px(const Camera& start, const Ellipsoid& ellipsoid, glm::dvec2 from, glm::dvec2 to,
                                   HeadingRule rule) {
  const View view = make_view(start, ellipsoid, kPinViewport);
  const Grab held = grab(view, ellipsoid, from);
  if (!held.on_surface || grazing(view, ellipsoid, held.point)) return {};
  const Camera moved = pin(start, ellipsoid, kPinViewport, held.point, to, rule);
  EXPECT_TRUE(std::isfinite(moved.eye.lat.rad() + moved.eye.lon.rad() + moved.heading.rad()));
  const View there = make_view(moved, ellipsoid, kPinViewport);
  const Grab now = grab(there, ellipsoid, to);
  if (!now.on_surface || grazing(there, ellipsoid, now.point)) return {};
  return miss_px(moved, ellipsoid, held.point, to);
}

TEST(SurfacePin, HoldsTheGrabbedPointOnEveryBodyAtEveryHeightAndTilt) {
  std::mt19937_64 random(20240611);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const Ellipsoid bodies[] = {earth().ellipsoid, Ellipsoid(11.0e3, 0.0), Ellipsoid(60268.0e3, 0.098)};
  int held = 0;
  for (int i = 0; i < 3000; ++i) {
    const Ellipsoid& body = bodies[i % 3];
    const double height_m = body.a_m() * std::pow(10.0, -5.0 + 6.0 * unit(random));
    const Camera c = camera_at(180.0 * unit(random) - 90.0, 360.0 * unit(random) - 180.0, height_m,
                               360.0 * unit(random) - 180.0, -90.0 + 80.0 * unit(random));
    const glm::dvec2 from(1024.0 * unit(random), 768.0 * unit(random));
    const glm::dvec2 to = from + 200.0 * glm::dvec2(unit(random) - 0.5, unit(random) - 0.5);
    const HeadingRule rule = unit(random) < 0.5 ? HeadingRule::keep : HeadingRule::carry;
    const auto miss = drag_miss_px(c, body, from, to, rule);
    if (!miss) continue;
    ++held;
    EXPECT_LT(*miss, kPinned_px) << "case " << i << " height " << height_m << " lat " << c.eye.lat.deg() << " pitch "
                                 << c.pitch.deg() << " keep " << (rule == HeadingRule::keep);
  }
  EXPECT_GT(held, 800);
}

TEST(SurfacePin, KeepsTheHeadingAtMidLatitudes) {
  const Camera start = camera_at(45.0, 20.0, 3.0e6, 30.0, -60.0);
  const Grab held = grab(make_view(start, earth().ellipsoid, kPinViewport), earth().ellipsoid, {400.0, 500.0});
  const Camera moved = pin(start, earth().ellipsoid, kPinViewport, held.point, {700.0, 420.0}, HeadingRule::keep);
  EXPECT_NEAR(moved.heading.deg(), 30.0, 1e-9);
  EXPECT_GT(std::abs(moved.eye.lon.deg() - 20.0), 5.0);
  EXPECT_DOUBLE_EQ(moved.eye.height_m, 3.0e6);
}

TEST(SurfacePin, StaysWhenTheCursorDoes) {
  const Camera start = camera_at(-89.999, 170.0, 4.0e5, -120.0, -35.0);
  const Grab held = grab(make_view(start, earth().ellipsoid, kPinViewport), earth().ellipsoid, {512.0, 600.0});
  for (const HeadingRule rule : {HeadingRule::keep, HeadingRule::carry}) {
    const Camera moved = pin(start, earth().ellipsoid, kPinViewport, held.point, {512.0, 600.0}, rule);
    EXPECT_LT(miss_px(moved, earth().ellipsoid, held.point, {512.0, 600.0}), kPinned_px);
    EXPECT_NEAR(moved.eye.lat.deg(), start.eye.lat.deg(), 1e-9);
    EXPECT_NEAR(moved.heading.deg(), start.heading.deg(), 1e-4);  // 1e-9 of a turn about the pole, 110 m away
  }
}

TEST(Grab, JoinsTheLimbWithoutAStep) {
  const Ellipsoid saturn(60268.0e3, 0.098);
  const View view = make_view(camera_at(35.0, 10.0, 2.0e8), saturn, kPinViewport);
  double inside = 512.0;
  double outside = 0.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (inside + outside);
    (grab(view, saturn, {middle, 384.0}).on_surface ? inside : outside) = middle;
  }
  const glm::dvec3 limb = grab(view, saturn, {inside, 384.0}).point.xyz_m;
  const glm::dvec3 past = grab(view, saturn, {outside, 384.0}).point.xyz_m;
  EXPECT_LT(glm::distance(limb, past), 1e-5 * saturn.a_m());  // sqrt of the pixel's last bit: 1e-6 of the radius
}

TEST(Grab, GoesOnTurningPastTheLimb) {
  const View view = make_view(camera_at(0.0, 0.0, 2.0e7), earth().ellipsoid, kPinViewport);
  double last = 0.0;
  for (const double x : {600.0, 700.0, 800.0, 900.0, 1000.0}) {
    const glm::dvec3 p = grab(view, earth().ellipsoid, {x, 384.0}).point.xyz_m;
    const double lon = std::atan2(p.y, p.x);
    EXPECT_GT(lon, last);
    last = lon;
  }
}

TEST(HeadingRule, IsCarriedOnlyWhereThePoleIsNear) {
  const Ellipsoid& body = earth().ellipsoid;
  const auto rule = [&](const Camera& c) { return heading_rule(c, body, body.to_ecef(c.eye)); };
  EXPECT_EQ(rule(camera_at(45.0, 0.0, 6.0e6)), HeadingRule::keep);
  EXPECT_EQ(rule(camera_at(80.0, 0.0, 6.0e6)), HeadingRule::carry);
  EXPECT_EQ(rule(camera_at(80.0, 0.0, 1.0e4)), HeadingRule::keep);
  EXPECT_EQ(rule(camera_at(-90.0, 0.0, 1.0)), HeadingRule::carry);
}

}  // namespace
}  // namespace terrella
