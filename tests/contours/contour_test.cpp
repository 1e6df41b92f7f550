// Contour lines of a layer of numbers, against the values of a formula under each pixel.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/gl/gl_fixture.h"
#include "tests/gl/layer_source.h"
#include "tests/gl/painted_heights.h"
#include "tests/gl/painted_numbers.h"
#include "tests/scene/patch_test_support.h"

namespace terrella::test {
namespace {

constexpr Viewport kSeen{240, 180};
constexpr TileGrid kGrid{.tile_px = 64, .max_level = 5};
constexpr double kStep = 20.0;
constexpr double kGrey = 200.0, kInk = 0.75;  // the map's only colour; how dark a line makes it (patch_taps.glsl)

/// Hills of some degrees, smooth beside the texels of kGrid, which are 0.09° wide.
double hills(double lat, double lon) {
  constexpr double kDegree = std::numbers::pi / 180.0;
  return 100.0 * (std::sin(6.0 * lat * kDegree) + std::cos(6.0 * lon * kDegree) * std::cos(lat * kDegree));
}

/// Straight down far and near, a pole, ±180°, a view to the horizon.
std::vector<Camera> contour_cameras() {
  return {camera_at(5, 20, 1.0e7), camera_at(35, 5, 6.0e5), camera_at(90, 0, 3.0e6), camera_at(10, 180, 4.0e6),
          camera_at(40, 10, 4.0e5, 30, -20)};
}

/// A grey layer of numbers with contour lines.
class Contours : public GlTest {
 protected:
  static NumberLook lines(double step) {
    return {.low = -1.0, .high = 1.0, .colors = {.stops = {{0.0, {200, 200, 200}}}}, .contour_step = step};
  }
  static LayerId add(Globe& globe, double step, const PaintedNumbers::Paint& paint) {
    const auto layer = globe.add_imagery(std::make_shared<PaintedNumbers>(kGrid, paint), {.numbers = lines(step)});
    EXPECT_TRUE(layer);
    return layer ? *layer : LayerId::none;
  }
  static void add_hills(Globe& globe, double step) {
    add(globe, step, [](double lon, double lat) { return static_cast<float>(hills(lat, lon)); });
  }
  static std::unique_ptr<Globe> globe() {
    auto made = Globe::create({});
    EXPECT_TRUE(made);
    return made ? std::move(*made) : nullptr;
  }

  /// The value in steps under a place of the picture; nothing beside the globe.
  static std::optional<double> steps_at(const View& view, const Ground& ground, glm::dvec2 px, double step) {
    const auto place = pick(view, ground, px);
    if (!place) return std::nullopt;
    return hills(place->lat.deg(), place->lon.deg()) / step;
  }

  struct Errors {
    int lines = 0;  ///< pixels that a line should cover
    int off = 0;    ///< pixels whose cover differs from that of the true line by more than half
  };
  /// A line covers 1 pixel minus the distance of its middle, so that a difference is an offset in pixels. Only where
  /// lines are 5 to 200 pixels apart: closer ones fade, and further apart rounding to 8 bits moves them. And not on the
  /// very tops, where the slope changes within a pixel and a line is a spot.
  Errors errors(Globe& globe, const Camera& camera, double step) {
    globe.set_camera(camera);
    settle(globe, kSeen);
    const Picture seen = picture();
    const View view = globe.view(kSeen);
    Errors errors;
    for (int y = 2; y < kSeen.height_px - 2; ++y) {
      for (int x = 2; x < kSeen.width_px - 2; ++x) {
        const glm::dvec2 at(x + 0.5, y + 0.5);
        const auto steps_from = [&](double dx, double dy) {
          return steps_at(view, globe.ground(), at + glm::dvec2(dx, dy), step);
        };
        const auto here = steps_from(0, 0), left = steps_from(-1, 0), right = steps_from(1, 0), up = steps_from(0, -1),
                   down = steps_from(0, 1);
        if (!here || !left || !right || !up || !down) continue;
        const double a_pixel = std::hypot(*right - *left, *down - *up) / 2.0, line = std::round(*here);
        const double bend = std::max(std::abs(*right + *left - 2.0 * *here), std::abs(*down + *up - 2.0 * *here));
        if (a_pixel > 0.2 || a_pixel < 0.005 || bend > 0.1 * a_pixel) continue;
        const double half_px = std::fmod(line, 5.0) == 0.0 ? 1.0 : 0.5;
        const double cover = std::clamp(half_px + 0.5 - std::abs(*here - line) / a_pixel, 0.0, 1.0);
        errors.lines += cover > 0.5 ? 1 : 0;
        const double shown = (kGrey - static_cast<double>(seen.at(x, y)[0])) / kGrey / kInk;
        errors.off += std::abs(shown - cover) > 0.5 ? 1 : 0;
      }
    }
    return errors;
  }
  void expect_right(Globe& globe, const std::vector<Camera>& cameras = contour_cameras()) {
    for (const Camera& camera : cameras) {
      const Errors found = errors(globe, camera, kStep);
      EXPECT_GT(found.lines, 100);
      // A row of pixels beside tiles of another level takes its slope from texels that are repeated there.
      EXPECT_LE(found.off, found.lines / 100) << camera.eye.lat.deg() << " " << camera.eye.height_m;
    }
  }
};

TEST_F(Contours, LieWithinHalfAPixelOfTheTrueOnes) {
  const auto globe = this->globe();
  add_hills(*globe, kStep);
  expect_right(*globe);
}

TEST_F(Contours, LieThereInAPassOfSeveralLayers) {
  const auto globe = this->globe();
  ASSERT_TRUE(globe->add_imagery(one_colour(kGrid, {120, 60, 30})));
  add_hills(*globe, kStep);
  expect_right(*globe);
}

TEST_F(Contours, LieThereOnRelief) {
  const auto heights = ElevationSource::open(
      painted_heights({.tile_px = 64, .max_level = 2},
                      [](double lat, double lon) { return 3000.0 * std::sin(6.0 * lat) * std::cos(6.0 * lon); }),
      "heights");
  ASSERT_TRUE(heights);
  const auto globe = this->globe();
  add_hills(*globe, kStep);
  ASSERT_TRUE(globe->set_elevation(*heights));
  // Without silhouettes, where a pixel's neighbours lie on other hills.
  expect_right(*globe, {camera_at(5, 20, 1.0e7), camera_at(35, 5, 6.0e5), camera_at(40, 10, 4.0e5, 30, -50)});
}

TEST_F(Contours, AFlatPlaceAtTheValueOfALineHasNone) {
  const auto globe = this->globe();
  // Plains at -20, 0, 20 …: each is flat at the value of a line, and between them are cliffs.
  add(*globe, 10.0, [](double lon, double) { return static_cast<float>(20.0 * std::floor(lon / 20.0)); });
  globe->set_camera(camera_at(0, 10, 8.0e5));
  settle(*globe, kSeen);
  EXPECT_EQ(static_cast<int>(picture().at(kSeen.width_px / 2, kSeen.height_px / 2)[0]), static_cast<int>(kGrey));
}

TEST_F(Contours, ThatAreTooCloseFadeAway) {
  const auto globe = this->globe();
  add_hills(*globe, 0.01);
  globe->set_camera(camera_at(37, 7, 1.0e7));
  settle(*globe, kSeen);
  EXPECT_EQ(static_cast<int>(picture().at(kSeen.width_px / 2, kSeen.height_px / 2)[0]), static_cast<int>(kGrey));
}

TEST_F(Contours, AreTakenAwayAgain) {
  const auto globe = this->globe();
  const LayerId layer = add(*globe, 10.0, [](double lon, double lat) { return static_cast<float>(hills(lat, lon)); });
  globe->set_camera(camera_at(5, 20, 1.0e7));
  settle(*globe, kSeen);
  const Picture with = picture();
  ImageLook look = *globe->look(layer);
  look.numbers->contour_step = 0.0;
  ASSERT_TRUE(globe->set_look(layer, look));
  settle(*globe, kSeen);
  EXPECT_NE(picture().rgba, with.rgba);
  look.numbers->contour_step = -1.0;
  EXPECT_FALSE(globe->set_look(layer, look));
}

}  // namespace
}  // namespace terrella::test
