// Paper 2: a translucent surface shows once in every pixel, whatever its relief, its patches and their order.
#include <gtest/gtest.h>

#include <cmath>

#include "globe/experiments.h"
#include "tests/gl/eye_sights.h"
#include "tests/gl/painted_heights.h"
#include "tests/scene/patch_test_support.h"

namespace terrella::test {
namespace {

constexpr Color kRocks = {220, 190, 140};
constexpr Viewport kGroundPicture{96, 96};
constexpr double kMountains_m = 5000.0;
// Share of the radius: mountains ten times as deep reach 50 km down, and the limb takes its colours from both sides.
constexpr double kLowestGround = 0.02;
// Blending rounds once, and the picture once more.
constexpr int kRounding = 1;

/// 4° apart, as high as they are deep: seen from among them one stands behind the other.
double mountains_m(double lat_rad, double lon_rad) {
  return 0.5 * kMountains_m * (std::sin(90.0 * lat_rad) + std::cos(90.0 * lon_rad) * std::cos(lat_rad));
}

struct Eyepoint {
  const char* name;
  Camera camera;
};
const std::vector<Eyepoint> kEyepoints = {
    {"among mountains", camera_at(10, 20, 6.0e4, 90, -5, 60)},
    {"over the pole", camera_at(89.9, 0, 2.0e6, 10, -60, 60)},
    {"whole globe", camera_at(-10, 179, 9.0e6)},
};

/// With one eye from everywhere; what two eyes could spoil, from one place.
std::vector<Eyepoint> eyepoints(Stereo stereo) {
  if (stereo == Stereo::off) return kEyepoints;
  return {kEyepoints.front()};
}

class Paper2Surface : public GlTest, public testing::WithParamInterface<Stereo> {
 protected:
  std::unique_ptr<Globe> rocks(GlobeOptions options, const Camera& camera) {
    options.stereo.mode = GetParam();
    options.exaggeration = 10.0;
    auto heights = ElevationSource::open(painted_heights({.tile_px = 64, .max_level = 3}, mountains_m), "mountains");
    EXPECT_TRUE(heights);
    auto globe = Globe::create(options, one_colour({.tile_px = 64, .max_level = 1}, kRocks), *heights);
    EXPECT_TRUE(globe);
    (*globe)->set_camera(camera);
    settle(**globe, size());
    return std::move(*globe);
  }
  [[nodiscard]] static Viewport size() { return picture_size(GetParam(), kGroundPicture); }

  /// Pixels of all eyes.
  struct Judged {
    int ground = 0;    ///< pixels whose line of sight meets the lowest ground
    int holes = 0;     ///< those `ground` pixels that do not show the surface exactly once
    int brighter = 0;  ///< pixels brighter than the surface shown once
  };
  Judged judge(const Globe& globe, const SurfaceLook& look) {
    const Picture seen = picture();
    const Color once = blended(look, kRocks, {0, 0, 0});
    Judged judged;
    for (const EyeSight& eye : eye_sights(globe, seen)) {
      const std::vector<glm::ivec2> inside = pixels_inside(eye, earth().ellipsoid, kLowestGround);
      judged.ground += static_cast<int>(inside.size());
      for (const glm::ivec2 px : inside) judged.holes += eye.sees(eye.at(px), once, kRounding) ? 0 : 1;
      for (int y = 0; y < kGroundPicture.height_px; ++y) {
        for (int x = 0; x < kGroundPicture.width_px && eye.has_row(y); ++x) {
          for (std::size_t k = 0; k < 3; ++k) judged.brighter += is_brighter(eye, {x, y}, once, k) ? 1 : 0;
        }
      }
    }
    return judged;
  }
  static bool is_brighter(const EyeSight& eye, glm::ivec2 px, const Color& once, std::size_t channel) {
    return eye.channels[channel] && eye.at(px)[channel] > once[channel] + kRounding;
  }
};

GlobeOptions glass(double alpha) {
  GlobeOptions options = unlit_options();
  options.surface.alpha = alpha;
  return options;
}

TEST_P(Paper2Surface, ShowsOnceWithoutSkirtsCracksOrMountainsBehindMountains) {
  for (const Eyepoint& eyepoint : eyepoints(GetParam())) {
    const auto globe = rocks(glass(0.5), eyepoint.camera);
    for (const Blend blend : {Blend::normal, Blend::additive}) {
      for (const double alpha : {0.1, 0.5, 0.9, 1.0}) {
        const SurfaceLook look{.alpha = alpha, .blend = blend};
        globe->set_surface(look);
        draw(*globe, size());
        const Judged judged = judge(*globe, look);
        EXPECT_GT(judged.ground, 1000) << eyepoint.name;
        EXPECT_EQ(judged.holes, 0) << eyepoint.name << ", alpha " << alpha;
        EXPECT_EQ(judged.brighter, 0) << eyepoint.name << ", alpha " << alpha;
      }
    }
  }
}

TEST_P(Paper2Surface, ShowsTwiceWhereTransparencyIsJustSwitchedOn) {
  GlobeOptions naive = glass(0.5);
  const auto globe = rocks(naive, kEyepoints.front().camera);
  Experiments::of(*globe).naive_translucency = true;
  // Ground behind shows only if its patch comes first.
  int brighter = 0;
  for (unsigned seed = 1; seed <= 8 && brighter <= 50; ++seed) {
    Experiments::of(*globe).patch_shuffle = seed;
    draw(*globe, size());
    brighter = judge(*globe, naive.surface).brighter;
  }
  EXPECT_GT(brighter, 50) << "paper 2's figure 2.25 is not reproduced";
}

TEST_P(Paper2Surface, DoesNotDependOnTheOrderOfPatches) {
  for (const Eyepoint& eyepoint : eyepoints(GetParam())) {
    const auto globe = rocks(glass(0.5), eyepoint.camera);
    for (const double alpha : {0.5, 1.0}) {
      globe->set_surface({.alpha = alpha});
      Experiments::of(*globe).patch_shuffle.reset();
      draw(*globe, size());
      const Picture first = picture();
      for (const unsigned seed : {1U, 2U, 3U}) {
        Experiments::of(*globe).patch_shuffle = seed;
        draw(*globe, size());
        EXPECT_EQ(first.rgba, picture().rgba) << eyepoint.name << ", alpha " << alpha << ", order " << seed;
      }
    }
  }
}

TEST_P(Paper2Surface, DependsOnItWhereTransparencyIsJustSwitchedOn) {
  GlobeOptions naive = glass(0.5);
  const auto globe = rocks(naive, kEyepoints.front().camera);
  Experiments::of(*globe).naive_translucency = true;
  draw(*globe, size());
  const Picture first = picture();
  Experiments::of(*globe).patch_shuffle = 1U;
  draw(*globe, size());
  EXPECT_NE(first.rgba, picture().rgba) << "shuffling changes nothing: the test above sees nothing";
}

INSTANTIATE_TEST_SUITE_P(ByEye, Paper2Surface, testing::ValuesIn(kAllStereo), &stereo_test_name);

}  // namespace
}  // namespace terrella::test
