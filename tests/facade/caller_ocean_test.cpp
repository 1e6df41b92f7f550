// An application's own ocean meets mountains where rays say that are cast at the same surfaces in double.
#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>

#include "caller_scene.h"
#include "tests/gl/gl_dump.h"

namespace terrella::test {
namespace {

/// Steep, so that a shore is sharp: 2.5 km high and 27 km apart, 22 texels of the tiles below.
double fjords_m(double lat_rad, double lon_rad) {
  return 2500.0 * std::sin(1500.0 * lat_rad) * std::cos(1500.0 * lon_rad);
}

/// A surface at one height over the ellipsoid, all around the eye, as a net of triangles.
class Ocean : public CallerMesh {
 public:
  Ocean(const Globe& globe, double tide_m)
      : CallerMesh(globe.options().depth, net(globe.options().body.ellipsoid, globe.camera().eye, tide_m)),
        a_m_(globe.options().body.ellipsoid.a_m() + tide_m),
        b_m_(globe.options().body.ellipsoid.b_m() + tide_m) {}

  /// Distance along a ray to the surface; infinite if it misses. A surface parallel to an ellipsoid is within a
  /// millimetre an ellipsoid too, at the heights of tides.
  [[nodiscard]] double hit_m(const glm::dvec3& from_m, const glm::dvec3& way) const {
    const glm::dvec3 scale(1.0 / a_m_, 1.0 / a_m_, 1.0 / b_m_);
    const glm::dvec3 o = from_m * scale, d = way * scale;
    const double a = glm::dot(d, d), b = glm::dot(o, d), c = glm::dot(o, o) - 1.0;
    const double root2 = b * b - a * c;
    return root2 > 0.0 && b < 0.0 ? c / (-b + std::sqrt(root2)) : HUGE_VAL;
  }

 private:
  // Out to the horizon and beyond. Triangles of 3 km lie at most 0.2 m under the surface: a thousandth of a pixel, and
  // a shore on such slopes is off by as little.
  static std::vector<glm::dvec3> net(const Ellipsoid& body, const Geodetic& middle, double tide_m) {
    constexpr int kCells = 300;
    constexpr double kStep_deg = 0.03;
    const auto corner = [&](int row, int column) {
      return body
          .to_ecef({.lat = Angle::degrees(middle.lat.deg() + kStep_deg * (row - kCells / 2)),
                    .lon = Angle::degrees(middle.lon.deg() + 1.5 * kStep_deg * (column - kCells / 2)),
                    .height_m = tide_m})
          .xyz_m;
    };
    std::vector<glm::dvec3> corners;
    for (int row = 0; row < kCells; ++row) {
      for (int column = 0; column < kCells; ++column) {
        for (const auto& [r, c] : {std::pair{0, 0}, {0, 1}, {1, 1}, {0, 0}, {1, 1}, {1, 0}}) {
          corners.push_back(corner(row + r, column + c));
        }
      }
    }
    return corners;
  }

  double a_m_, b_m_;
};

/// Depth, samples of a pixel, height of the ocean.
using OceanCase = std::tuple<DepthMode, int, double>;

class CallerOcean : public GlTest, public testing::WithParamInterface<OceanCase> {
 protected:
  static DepthMode depth() { return std::get<0>(GetParam()); }
  static std::unique_ptr<Globe> fjords(double alpha) {
    return globe_of(depth(), alpha, painted_heights({.tile_px = 128, .max_level = 7}, fjords_m));
  }
  static double tide_m() { return std::get<2>(GetParam()); }
  /// Pixels that differ from the truth although no ray within a pixel of them agrees with what was drawn. Islands and
  /// creeks may be narrower than a pixel.
  static std::ptrdiff_t wrong(const Globe& globe, const Ocean& ocean, const Picture& shot, int least_red, bool any) {
    const std::vector<bool> got = reds(shot, least_red);
    const View view = globe.view(kScene);
    constexpr int kRays = 16;
    return std::ranges::count_if(pixels_off(got, truth_of(globe, ocean, any)), [&](glm::ivec2 pixel) {
      const bool drawn = got[static_cast<std::size_t>(pixel.y * kScene.width_px + pixel.x)];
      for (int k = 0; k < kRays * kRays; ++k) {
        const glm::dvec2 beside(2.0 * (k % kRays) / kRays - 1.0, 2.0 * (k / kRays) / kRays - 1.0);
        if (meets(globe, view, ocean, any, glm::dvec2(pixel) + 0.5 + beside) == drawn) return false;
      }
      return true;
    });
  }
  /// Draws the globe with the callback. Fails the test if a state of OpenGL is not as it was found.
  Picture drawn(Globe& globe) {
    const int samples = std::get<1>(GetParam());
    if (samples == 0) settle(globe, kScene);
    const SampledTarget target(kScene, std::max(samples, 1));
    const GlDump before = dump_gl_state();
    if (samples > 0) settle_into(globe, target, kScene);
    if (samples == 0) draw(globe, kScene);
    EXPECT_EQ(differences(before, dump_gl_state()), "");
    return samples > 0 ? target.read() : picture();
  }
};

TEST_P(CallerOcean, MeetsMountainsWhereRaysSayAtEachStage) {
  const auto globe = fjords(1.0);
  const Ocean ocean(*globe, tide_m());
  for (const DrawStage stage : {DrawStage::ground, DrawStage::all}) {
    globe->on_draw([&](DrawStage at, const FrameMatrices& matrices) {
      EXPECT_EQ(matrices.depth, depth());
      if (at == stage) ocean.draw();
    });
    const Picture shot = drawn(*globe);
    EXPECT_GT(std::ranges::count(reds(shot, 128), true), 2000);
    EXPECT_GT(std::ranges::count(reds(shot, 128), false), 2000);
    EXPECT_EQ(wrong(*globe, ocean, shot, 128, false), 0);
  }
}

// Under half-translucent mountains the whole ocean shows, its part in the open undimmed.
TEST_P(CallerOcean, ShowsThroughTranslucentMountains) {
  const auto globe = fjords(0.5);
  const Ocean ocean(*globe, tide_m());
  globe->on_draw([&](DrawStage at, const FrameMatrices&) {
    if (at == DrawStage::below_ground || at == DrawStage::all) ocean.draw();
  });
  const Picture shot = drawn(*globe);
  EXPECT_EQ(wrong(*globe, ocean, shot, 64, true), 0);
  EXPECT_EQ(wrong(*globe, ocean, shot, 200, false), 0);
}

INSTANTIATE_TEST_SUITE_P(Depths, CallerOcean,
                         testing::Values(OceanCase{DepthMode::reversed, kSamples, 0.0},
                                         OceanCase{DepthMode::logarithmic, kSamples, 0.0},
                                         OceanCase{DepthMode::standard, kSamples, 0.0},
                                         OceanCase{DepthMode::reversed, 0, 400.0}));

}  // namespace
}  // namespace terrella::test
