// The globe has no hole, no crack, no triangle the wrong way and no NaN.
#include <gtest/gtest.h>

#include <iostream>
#include <sstream>

#include "tests/gl/gl_fixture.h"
#include "tests/scene/patch_test_support.h"

namespace terrella::test {
namespace {

constexpr Color kBright = {230, 200, 160};
constexpr Viewport kSmall{128, 128};
const TileGrid kGrid{.tile_px = 64, .max_level = 1};

bool hits(const View& view, const Ellipsoid& body, glm::dvec2 px) {
  return body.intersect_m(view.eye, pixel_ray(view, px)).has_value();
}

/// True if a pixel's centre is inside (or outside) the disc by more than a pixel.
bool well(bool inside, const View& view, const Ellipsoid& body, int x, int y) {
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      if (hits(view, body, glm::dvec2(x + 0.5 + dx, y + 0.5 + dy)) != inside) return false;
    }
  }
  return true;
}

struct Wrong {
  int holes = 0;    // background within the disc
  int outside = 0;  // imagery beyond the limb
};

/// Judges a picture of a globe whose imagery is `kBright` everywhere.
Wrong judge(const Picture& picture, const View& view, const Ellipsoid& body) {
  Wrong wrong;
  for (int y = 0; y < picture.size.height_px; ++y) {
    for (int x = 0; x < picture.size.width_px; ++x) {
      const bool imagery = picture.at(x, y) == kBright;
      if (!imagery && well(true, view, body, x, y)) ++wrong.holes;
      if (imagery && !hits(view, body, glm::dvec2(x + 0.5, y + 0.5)) && well(false, view, body, x, y)) ++wrong.outside;
    }
  }
  return wrong;
}

std::string words(const Camera& c) {
  std::ostringstream out;
  out.precision(12);
  out << c.eye.lat.deg() << ',' << c.eye.lon.deg() << ',' << c.eye.height_m << ',' << c.heading.deg() << ','
      << c.pitch.deg() << ',' << c.fov_y.deg();
  return out.str();
}

class GlobeCoverage : public GlTest {
 protected:
  /// Draws and judges; says which camera it was if something is wrong.
  void check(Globe& globe, const Camera& camera, Viewport size) {
    globe.set_camera(camera);
    const FrameStats stats = draw(globe, size);
    EXPECT_LE(stats.draw_calls, 10);
    const Wrong wrong = judge(picture(), globe.view(size), globe.options().body.ellipsoid);
    EXPECT_EQ(wrong.holes, 0) << "background inside the disc, camera " << words(camera) << " body "
                              << globe.options().body.name;
    EXPECT_EQ(wrong.outside, 0) << "imagery outside the disc, camera " << words(camera) << " body "
                                << globe.options().body.name;
  }

  std::unique_ptr<Globe> globe_of(const Body& body, GlobeOptions options = unlit_options()) {
    options.body = body;
    auto globe = make_globe(options, one_colour(kGrid, kBright));
    globe->set_camera(camera_at(0, 0, 3.0 * body.ellipsoid.a_m()));
    settle(*globe, kSmall);
    globe->set_camera(camera_at(0, 180, 3.0 * body.ellipsoid.a_m()));
    settle(*globe, kSmall);
    return globe;
  }
};

TEST_F(GlobeCoverage, NotOneBackgroundPixelInsideTheDiscForAThousandRandomCameras) {
  constexpr std::uint64_t kSeed = 20240901;
  std::cout << "seed " << kSeed << '\n';
  Draw draw(kSeed);
  const auto globe = globe_of(earth());
  // A failure names its camera; a few of them are enough.
  for (int k = 0; k < 1000 && !HasFailure(); ++k) check(*globe, random_camera(draw, 10.0, 1.0e8), kSmall);
}

// A crack is a quarter of a pixel wide at most: it takes many pixels along the borders to find one, at heights from
// which the mesh's own error decides where levels change.
TEST_F(GlobeCoverage, NoCracksBetweenLevels) {
  constexpr Viewport kLarge{768, 576};
  Draw draw(54);
  const auto globe = globe_of(earth());
  int holes = 0;
  for (int k = 0; k < 40; ++k) {
    Camera c = random_camera(draw, 2.0e5, 5.0e6);
    c.pitch = Angle::degrees(draw.between(-70.0, -10.0));
    c.fov_y = Angle::degrees(draw.between(30.0, 110.0));
    globe->set_camera(c);
    this->draw(*globe, kLarge);
    holes += judge(picture(), globe->view(kLarge), earth().ellipsoid).holes;
  }
  EXPECT_EQ(holes, 0) << "background pixels in 40 pictures";
}

TEST_F(GlobeCoverage, NoneForOtherBodiesEither) {
  Draw draw(51);
  for (const Body& body : selection_bodies()) {
    const auto globe = globe_of(body);
    const double a = body.ellipsoid.a_m();
    for (int k = 0; k < 60 && !HasFailure(); ++k) check(*globe, random_camera(draw, 1.6e-6 * a, 16.0 * a), kSmall);
  }
}

// The ground under the eye is the nearest there is, and so far from the picture's middle it has little depth.
TEST_F(GlobeCoverage, TheNearPlaneCutsNothingFromTheWidestPicture) {
  const auto globe = globe_of(earth());
  for (const double height_m : {2.0, 1.0e3, 1.0e6}) {
    Camera c = camera_at(20, 30, height_m);
    c.pitch = Angle::degrees(-5.2);
    c.fov_y = Angle::degrees(170.0);
    check(*globe, c, kSmall);
  }
}

TEST_F(GlobeCoverage, NoneInAnyDepthModeOrTexturing) {
  Draw draw(52);
  std::vector<GlobeOptions> all;
  for (const DepthMode depth : {DepthMode::logarithmic, DepthMode::standard}) {
    all.push_back(unlit_options());
    all.back().depth = depth;
  }
  for (const Texturing texturing : {Texturing::vertex, Texturing::paper, Texturing::exact}) {
    all.push_back(unlit_options());
    all.back().texturing = texturing;
  }
  for (const GlobeOptions& options : all) {
    const auto globe = globe_of(earth(), options);
    for (int k = 0; k < 40 && !HasFailure(); ++k) check(*globe, random_camera(draw, 10.0, 1.0e8), kSmall);
  }
}

TEST_F(GlobeCoverage, TheFarWallFillsThePictureOfACameraUnderTheGround) {
  Draw draw(53);
  GlobeOptions without_inner_sphere = unlit_options();
  without_inner_sphere.surface.inner_sphere_below_m.reset();
  const auto globe = globe_of(earth(), without_inner_sphere);
  for (int k = 0; k < 150 && !HasFailure(); ++k) {
    Camera c = random_camera(draw, 1.0, 6.3e6);
    c.eye.height_m = -c.eye.height_m;
    check(*globe, c, kSmall);
  }
  check(*globe, camera_at(90, 0, -earth().ellipsoid.b_m()), kSmall);
}

TEST_F(GlobeCoverage, ACameraAtThePlanetsCentreSeesTheWallLitOrNot) {
  const Body ball{"ball", Ellipsoid(6371000.0, 0.0)};
  const auto globe = globe_of(ball);
  check(*globe, camera_at(0, 0, -6371000.0, 0, 0), kSmall);
  globe->set_unlit(false);
  draw(*globe, kSmall);
  const Picture lit = picture();
  for (int k = 0; k < 128; ++k) EXPECT_GT(int{lit.at(k, k)[0]}, 0) << "no light at all, or not a number";
}

TEST_F(GlobeCoverage, TheHardViewsHaveNoHoles) {
  const auto globe = globe_of(earth());
  for (const double fov : {1.0, 40.0, 120.0}) {
    check(*globe, camera_at(90, 0, 1000, 33, -30, fov), kSmall);
    check(*globe, camera_at(-90, 0, 5.0e6, 200, -90, fov), kSmall);
    check(*globe, camera_at(12, 180, 1.0, 90, -3, fov), kSmall);
    check(*globe, camera_at(12, -180, 1.0e6, 90, -60, fov), kSmall);
    check(*globe, camera_at(45, 45, 3.844e8, 0, -90, fov), kSmall);
    check(*globe, camera_at(35.26438968, 45, 300, 0, -90, fov), kSmall);
    check(*globe, camera_at(35.26438968, -135, 2.0e6, 10, -70, fov), kSmall);
    check(*globe, camera_at(5, 5, 1.0, 0, 90, fov), kSmall);
  }
}

TEST_F(GlobeCoverage, TheSmallestAndTheWidestPictureHaveNoHoles) {
  const auto globe = globe_of(earth());
  for (const double fov : {1.0, 40.0, 120.0}) {
    check(*globe, camera_at(47, 8, 2000, 30, -20, fov), {1, 1});
    check(*globe, camera_at(47, 8, 2000, 30, -60, fov), {16384, 16});
    check(*globe, camera_at(47, 8, 4.0e6, 30, -90, fov), {16384, 16});
    check(*globe, camera_at(47, 8, 2000, 30, -60, fov), {16, 4096});
  }
}

TEST_F(GlobeCoverage, AViewThatIsNotANumberIsRefusedAndDrawsNothing) {
  const auto globe = globe_of(earth());
  for (const double bad : {kNaN, kInfinity}) {
    for (const Camera& camera : {camera_at(10, 20, bad), camera_at(bad, 20, 1000), camera_at(10, 20, 1000, bad)}) {
      globe->set_camera(camera);
      EXPECT_FALSE(globe->status());
      draw(*globe, kSmall);
      EXPECT_EQ(picture().at(64, 64), (Color{230, 200, 160})) << "the colour of a target in which nothing is drawn";
    }
  }
  check(*globe, camera_at(10, 20, 1.0e6), kSmall);
}

}  // namespace
}  // namespace terrella::test
