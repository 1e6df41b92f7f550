// The limb of a globe against the same picture drawn 8 by 8 times as large: no comb of steps along the limb, and no
// dashes of ice, with a sky and without.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "tests/gl/gl_fixture.h"
#include "tests/scene/patch_test_support.h"

namespace terrella::test {
namespace {

constexpr int kTimes = 8;
constexpr double kPeak_part = 0.05, kChange_part = 0.10;
// Half a level of rounding in each of two rows.
constexpr double kChange_levels = 0.5;

/// Channels of a picture, in levels.
struct Levels {
  int width = 0, height = 0;
  std::vector<double> values;
  [[nodiscard]] double at(int x, int y, int c) const {
    return values[static_cast<std::size_t>(3 * (y * width + x) + c)];
  }
};

Levels reduced(const Picture& p, int times) {
  Levels small{p.size.width_px / times, p.size.height_px / times, {}};
  for (int y = 0; y < small.height; ++y) {
    for (int x = 0; x < small.width; ++x) {
      for (std::size_t c = 0; c < 3; ++c) {
        double sum = 0.0;
        for (int j = 0; j < times; ++j) {
          for (int i = 0; i < times; ++i) sum += p.at(times * x + i, times * y + j)[c];
        }
        small.values.push_back(sum / (times * times));
      }
    }
  }
  return small;
}

/// The left limb: the brightest of the pixels beside it, row by row.
struct LimbRows {
  double peak = 0.0, change = 0.0;
};

LimbRows left_limb(const Levels& p, const std::vector<int>& begins, int channel) {
  std::vector<double> peaks;
  const int top = p.height / 5;
  for (std::size_t k = 0; k < begins.size(); ++k) {
    double peak = 0.0;
    for (int x = std::max(0, begins[k] - 1); x < begins[k] + 4; ++x)
      peak = std::max(peak, p.at(x, top + int(k), channel));
    peaks.push_back(peak);
  }
  LimbRows rows;
  for (std::size_t k = 0; k < peaks.size(); ++k) {
    rows.peak += peaks[k] / double(peaks.size());
    if (k > 0) rows.change += std::abs(peaks[k] - peaks[k - 1]) / double(peaks.size() - 1);
  }
  return rows;
}

/// The first column of the globe in each row of a picture.
std::vector<int> begins_of(const Levels& p) {
  std::vector<int> begins;
  for (int y = p.height / 5; y < p.height * 4 / 5; ++y) {
    int x = 0;
    while (x < p.width / 2 && p.at(x, y, 2) < 12.0) ++x;
    begins.push_back(x);
  }
  return begins;
}

/// Land, sea, and white floes of six degrees in a blue sea.
Color floes(double lon, double lat) {
  const double a = std::sin(lon * 0.12) * std::sin(lat * 0.15),
               b = std::sin(lon * 0.5 + lat * 0.1) * std::sin(lat * 0.45);
  if (b > 0.6) return {235, 240, 245};
  return a > 0.2 ? Color{90, 100, 60} : Color{20, 40, 90};
}

class LimbPictures : public GlTest {
 protected:
  void check(const Camera& camera, int size, bool sky) {
    SCOPED_TRACE("from " + std::to_string(camera.eye.height_m) + " m, " + std::to_string(size) + " px, sky " +
                 std::to_string(int(sky)));
    globe_->set_camera(camera);
    globe_->set_sky(sky);
    settle(*globe_, {kTimes * size, kTimes * size});
    const Levels truth = reduced(picture(), kTimes);
    settle(*globe_, {size, size});
    const Levels seen = reduced(picture(), 1);
    const std::vector<int> begins = begins_of(truth);
    for (int c = 0; c < 3; ++c) {
      const LimbRows expected = left_limb(truth, begins, c), drawn = left_limb(seen, begins, c);
      EXPECT_NEAR(drawn.peak, expected.peak, kPeak_part * expected.peak + 1.0) << "peak of channel " << c;
      EXPECT_NEAR(drawn.change, expected.change, kChange_part * expected.change + kChange_levels) << "channel " << c;
    }
  }
  void SetUp() override {
    GlTest::SetUp();
    GlobeOptions options;
    options.sky = true;
    globe_ = make_globe(options, std::make_shared<PaintedSource>(TileGrid{.tile_px = 128, .max_level = 3}, floes));
  }
  void TearDown() override {
    globe_.reset();
    GlTest::TearDown();
  }
  std::unique_ptr<Globe> globe_;
};

TEST_F(LimbPictures, HasNoCombWithASky) {
  check(camera_at(20.9, 0.1, 15202000), 200, true);
  check(camera_at(75.0, 10.0, 40000000, 30), 160, true);
}

TEST_F(LimbPictures, HasNoDashesWithoutASky) { check(camera_at(-40.0, 130.0, 12000000, 30), 160, false); }

// A ball whose centre lies under the ground, and which stands out over the limb. The Sun is over the eye's shoulder.
TEST_F(LimbPictures, HaveNoAirOverAnObject) {
  constexpr Viewport kPicture{400, 400};
  constexpr double kRadius_m = 6.0e5;
  const PointObject ball{.place = {.lat = Angle::degrees(20.0), .lon = Angle::degrees(72.0), .height_m = -1.0e5},
                         .radius_m = kRadius_m,
                         .color = {255, 64, 32, 255}};
  ASSERT_TRUE(globe_->add_objects({.points = {ball}}));
  const Camera camera = camera_at(20.9, 0.1, 15202000);
  globe_->set_camera(camera);
  const View view = make_view(camera, earth().ellipsoid, kPicture);
  const glm::dvec3 center = earth().ellipsoid.to_ecef(ball.place).xyz_m - view.eye.xyz_m;
  globe_->set_sky(false);
  settle(*globe_, kPicture);
  const Picture bare = picture();
  globe_->set_sky(true);
  settle(*globe_, kPicture);
  const Picture seen = picture();
  int pixels = 0;
  for (int y = 0; y < kPicture.height_px; ++y) {
    for (int x = 0; x < kPicture.width_px; ++x) {
      const glm::dvec3 ray = pixel_ray(view, {x + 0.5, y + 0.5}).xyz;
      if (glm::length(center - glm::dot(center, ray) * ray) > 0.9 * kRadius_m) continue;
      if (pick(view, earth().ellipsoid, {x + 0.5, y + 0.5})) continue;
      EXPECT_EQ(seen.at(x, y), bare.at(x, y)) << x << ", " << y;
      ++pixels;
    }
  }
  EXPECT_GT(pixels, 100) << "the ball is not over the limb";
}

}  // namespace
}  // namespace terrella::test
