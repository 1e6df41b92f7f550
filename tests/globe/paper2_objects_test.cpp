// Paper 2, section 2 of the seeds, by pixels and by eye: what lies under the near side shines through the surface, what
// lies under the far side never does, what is over the ground is over it.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "globe/experiments.h"
#include "tests/gl/eye_sights.h"
#include "tests/scene/patch_test_support.h"

namespace terrella::test {
namespace {

constexpr Color kGroundColor = {200, 120, 40}, kRed = {230, 40, 60}, kBlue = {40, 60, 230}, kGreen = {40, 230, 60};
constexpr Color kBlack = {0, 0, 0};
constexpr Viewport kEyePicture{160, 160};
const TileGrid kObjectsGrid{.tile_px = 64, .max_level = 1};
// Blending rounds once, and the picture once more.
constexpr int kOneLevel = 1;

PointObject ball(double lat, double lon, double height_m, const Color& c) {
  return {.place = {.lat = Angle::degrees(lat), .lon = Angle::degrees(lon), .height_m = height_m},
          .radius_m = 1.5e5,
          .color = {c[0], c[1], c[2]}};
}

/// Balls under the far side of an eye over 0°N 0°E: all around its limb and to the antipode. From 8000 km up, lines of
/// sight are nearest to the centre 65° from the eye; 72° leaves room for the ball and for the other eye.
std::vector<PointObject> balls_under_the_far_side() {
  std::vector<PointObject> balls;
  for (double away = 72.0; away < 180.0; away += 6.0) {
    for (int turn = 0; turn < 360; turn += 30) {
      const double t = turn * std::numbers::pi / 180.0, d = away * std::numbers::pi / 180.0;
      const double lat = std::asin(std::sin(d) * std::sin(t));
      balls.push_back(ball(lat * 180.0 / std::numbers::pi,
                           std::atan2(std::sin(d) * std::cos(t), std::cos(d)) * 180.0 / std::numbers::pi, -3.0e5,
                           kBlue));
    }
  }
  return balls;
}

class Paper2Objects : public GlTest, public testing::WithParamInterface<Stereo> {
 protected:
  std::unique_ptr<Globe> globe_with(std::vector<PointObject> balls, GlobeOptions options = unlit_options(),
                                    const Camera& camera = camera_at(0, 0, 8.0e6, 0, -90, 60)) {
    options.stereo.mode = GetParam();
    auto globe = make_globe(options, one_colour(kObjectsGrid, kGroundColor));
    EXPECT_TRUE(globe->add_objects({.points = std::move(balls)}));
    globe->set_camera(camera);
    settle(*globe, size());
    return globe;
  }
  /// The picture with a surface of another look; nothing is loaded anew.
  Picture look(Globe& globe, const SurfaceLook& surface) {
    globe.set_surface(surface);
    draw(globe, size());
    return picture();
  }
  [[nodiscard]] static Viewport size() { return picture_size(GetParam(), kEyePicture); }
};

std::vector<SurfaceLook> looks() {
  std::vector<SurfaceLook> all;
  for (const Blend blend : {Blend::normal, Blend::additive}) {
    for (const double alpha : {0.0, 0.25, 0.5, 0.75, 1.0}) all.push_back({.alpha = alpha, .blend = blend});
  }
  return all;
}

std::string words_of(const SurfaceLook& look) {
  return (look.blend == Blend::normal ? "normal, alpha " : "additive, alpha ") + std::to_string(look.alpha);
}

/// Expects every eye to see a ball at its middle in this colour.
void expect_ball(const Globe& globe, const Picture& seen, const PointObject& ball, const Color& expected,
                 const std::string& where) {
  for (const EyeSight& eye : eye_sights(globe, seen)) {
    const auto px = eye.pixel_of(globe.options().body.ellipsoid.to_ecef(ball.place));
    ASSERT_TRUE(px) << where;
    const Color color = eye.at(*px);
    EXPECT_TRUE(eye.sees(color, expected, kOneLevel)) << where << ": " << words_of(eye, *px, color);
  }
}

TEST_P(Paper2Objects, UnderTheNearSideTheyShineThroughByTheFormula) {
  const PointObject red = ball(8, 10, -3.0e5, kRed);
  const PointObject bare = ball(-12, 5, -3.0e5, kBlack);  // not drawn: ground with nothing under it
  const auto globe = globe_with({red});
  for (const SurfaceLook& surface : looks()) {
    const Picture seen = look(*globe, surface);
    expect_ball(*globe, seen, red, blended(surface, kGroundColor, kRed), "red, " + words_of(surface));
    expect_ball(*globe, seen, bare, blended(surface, kGroundColor, kBlack), "ground, " + words_of(surface));
  }
}

TEST_P(Paper2Objects, UnderTheFarSideTheyNeverShow) {
  const auto with = globe_with(balls_under_the_far_side()), without = globe_with({ball(8, 10, -3.0e5, kBlack)});
  for (const SurfaceLook& surface : looks()) {
    const Picture seen = look(*with, surface);
    for (const EyeSight& eye : eye_sights(*with, seen)) {
      int blue = 0;
      for (const glm::ivec2 px : pixels_inside(eye, earth().ellipsoid, 0.02)) {
        blue += eye.sees(eye.at(px), blended(surface, kGroundColor, kBlack), kOneLevel) ? 0 : 1;
      }
      EXPECT_EQ(blue, 0) << eye.name << ", " << words_of(surface);
    }
  }
}

TEST_P(Paper2Objects, UnderTheFarSideTheyShowWhereTransparencyIsJustSwitchedOn) {
  GlobeOptions naive = unlit_options();
  naive.surface.alpha = 0.5;
  const auto globe = globe_with(balls_under_the_far_side(), naive);
  Experiments::of(*globe).naive_translucency = true;
  draw(*globe, size());
  const Picture seen = picture();
  for (const EyeSight& eye : eye_sights(*globe, seen)) {
    int blue = 0;
    for (const glm::ivec2 px : pixels_inside(eye, earth().ellipsoid, 0.02)) {
      blue += eye.sees(eye.at(px), blended(naive.surface, kGroundColor, kBlack), kOneLevel) ? 0 : 1;
    }
    EXPECT_GT(blue, 300) << eye.name << ": paper 2's figure 2.23 is not reproduced";
  }
}

TEST_P(Paper2Objects, WithoutAnInnerSphereTheFarSideIsThere) {
  PointObject large = ball(0, 150, -6.0e5, kBlue);
  large.radius_m = 5.0e5;
  const auto globe = globe_with({large});
  const Picture seen = look(*globe, {.alpha = 0.5, .inner_sphere_below_m = {}});
  for (const EyeSight& eye : eye_sights(*globe, seen)) {
    const auto px = eye.pixel_of(earth().ellipsoid.to_ecef(large.place));
    ASSERT_TRUE(px);
    EXPECT_TRUE(eye.sees(eye.at(*px), blended({.alpha = 0.5}, kGroundColor, kBlue), kOneLevel)) << eye.name;
  }
}

TEST_P(Paper2Objects, OverTheGroundTheyAreThemselvesHoweverTranslucentItIs) {
  const PointObject green = ball(-8, -10, 4.0e5, kGreen), over_limb = ball(0, 68, 5.0e5, kGreen),
                    behind = ball(0, 120, 4.0e5, kGreen);
  const auto globe = globe_with({green, over_limb, behind});
  const Color ground = kGroundColor;
  for (const SurfaceLook& surface : looks()) {
    const Picture seen = look(*globe, surface);
    expect_ball(*globe, seen, green, kGreen, "green, " + words_of(surface));
    expect_ball(*globe, seen, over_limb, kGreen, "green beside the globe, " + words_of(surface));
    expect_ball(*globe, seen, behind, blended(surface, ground, kBlack), "green behind the globe, " + words_of(surface));
  }
}

TEST_P(Paper2Objects, AreTheSameInAllKindsOfDepth) {
  const PointObject red = ball(8, 10, -3.0e5, kRed), green = ball(-8, -10, 4.0e5, kGreen);
  std::vector<PointObject> all = balls_under_the_far_side();
  all.push_back(red);
  all.push_back(green);
  for (const DepthMode depth : {DepthMode::reversed, DepthMode::logarithmic, DepthMode::standard}) {
    GlobeOptions options = unlit_options();
    options.depth = depth;
    options.surface.alpha = 0.4;
    const auto globe = globe_with(all, options);
    const Picture seen = picture();
    expect_ball(*globe, seen, red, blended(options.surface, kGroundColor, kRed), "red");
    expect_ball(*globe, seen, green, kGreen, "green");
    for (const EyeSight& eye : eye_sights(*globe, seen)) {
      int blue = 0;  // more blue than ground and red together have
      for (const glm::ivec2 px : pixels_inside(eye, earth().ellipsoid, 0.02)) blue += eye.at(px)[2] > 90 ? 1 : 0;
      EXPECT_EQ(eye.channels[2] ? blue : 0, 0) << eye.name;
    }
  }
}

TEST_P(Paper2Objects, SeenFromBelowTheSurfaceIsOpaqueOrTranslucentOrLetsTheChosenThrough) {
  PointObject chosen = ball(10, 20.5, 2.5e5, kRed), other = ball(10, 17.0, 2.5e5, kBlue);
  chosen.through_surface = true;
  chosen.radius_m = other.radius_m = 6.0e4;
  PointObject under = ball(9.4, 19.0, -8.0e4, kGreen);
  under.radius_m = 1.0e4;
  const PointObject bare = ball(11.5, 19.0, 0.0, kBlack);
  GlobeOptions options = unlit_options();
  options.surface.alpha = 0.5;
  const auto globe = globe_with({chosen, other, under}, options, camera_at(8, 19, -4.0e5, 0, 60, 70));
  const auto shows = [&](SurfaceFromBelow mode, const Color& red, const Color& blue, const Color& ground) {
    const Picture seen = look(*globe, {.alpha = 0.5, .from_below = mode});
    const std::string where = "mode " + std::to_string(static_cast<int>(mode));
    expect_ball(*globe, seen, chosen, red, where + ", chosen");
    expect_ball(*globe, seen, other, blue, where + ", other");
    expect_ball(*globe, seen, under, kGreen, where + ", under the ground");
    expect_ball(*globe, seen, bare, ground, where + ", ground");
  };
  const SurfaceLook half{.alpha = 0.5};
  const Color red = blended(half, kGroundColor, kRed), blue = blended(half, kGroundColor, kBlue);
  shows(SurfaceFromBelow::opaque, kGroundColor, kGroundColor, kGroundColor);
  shows(SurfaceFromBelow::translucent, red, blue, blended(half, kGroundColor, kBlack));
  shows(SurfaceFromBelow::selective, red, kGroundColor, kGroundColor);
}

INSTANTIATE_TEST_SUITE_P(ByEye, Paper2Objects, testing::ValuesIn(kAllStereo), &stereo_test_name);

}  // namespace
}  // namespace terrella::test
