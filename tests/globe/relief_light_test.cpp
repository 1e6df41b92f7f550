// Light on relief, against the light of the analytic normals where rays meet the ground.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "tests/gl/gl_fixture.h"
#include "tests/gl/painted_heights.h"
#include "tests/scene/patch_test_support.h"

namespace terrella::test {
namespace {

constexpr Color kSlopeGround = {150, 150, 150};
constexpr Viewport kSlopePicture{128, 128};
constexpr double kWave_m = 2000.0, kWavesPerRadian = 300.0;  // 1.2° apart
// 0.088° a height: 14 heights a wave.
const TileGrid kSlopeHeights{.tile_px = 64, .max_level = 5};
const TileGrid kSlopeImagery{.tile_px = 64, .max_level = 1};

double wave_m(double lat, double lon) {
  return kWave_m * std::sin(kWavesPerRadian * lat) * std::cos(kWavesPerRadian * lon);
}

/// Rise per metre towards east and north, by the formula's own derivatives.
glm::dvec2 slope_at(double lat, double lon) {
  const double a_m = earth().ellipsoid.a_m(), k = kWavesPerRadian;
  return {-kWave_m * k * std::sin(k * lat) * std::sin(k * lon) / (a_m * std::cos(lat)),
          kWave_m * k * std::cos(k * lat) * std::cos(k * lon) / a_m};
}

/// The light of a slope as a factor of level ground's: 1.3 times the change of the light's sine, at most ±0.6.
double light_factor(glm::dvec2 slope, const glm::dvec3& light_enu) {
  const glm::dvec3 normal = glm::normalize(glm::dvec3(-slope, 1.0));
  const double gain = 1.3 * (glm::dot(normal, light_enu) - light_enu.z);
  return 1.0 + gain / std::sqrt(1.0 + gain * gain / 0.36);
}

/// Levels of the pixels of a row-major picture.
struct Levels {
  std::vector<double> seen, truth;
  [[nodiscard]] static double bend(const std::vector<double>& of) {
    double sum = 0.0;
    int n = 0;
    for (int y = 0; y < kSlopePicture.height_px; ++y) {
      for (int x = 1; x + 1 < kSlopePicture.width_px; ++x, ++n) {
        const auto k = static_cast<std::size_t>(y * kSlopePicture.width_px + x);
        const double second = of[k - 1] - 2.0 * of[k] + of[k + 1];
        sum += second * second;
      }
    }
    return std::sqrt(sum / n);
  }
  [[nodiscard]] double mean_error() const {
    double sum = 0.0;
    for (std::size_t k = 0; k < seen.size(); ++k) sum += std::abs(seen[k] - truth[k]);
    return sum / static_cast<double>(seen.size());
  }
};

class ReliefLight : public GlTest {
 protected:
  static std::unique_ptr<Globe> waves(GlobeOptions options) {
    options.relief_meshes_per_frame = std::numeric_limits<int>::max();
    auto heights = ElevationSource::open(painted_heights(kSlopeHeights, wave_m), "waves");
    auto globe = Globe::create(options, one_colour(kSlopeImagery, kSlopeGround), *heights);
    EXPECT_TRUE(globe);
    return std::move(*globe);
  }
  /// Levels seen and true from straight above, where level ground has its full light.
  Levels levels(Globe& globe, double height_m) {
    globe.set_camera(camera_at(10, 20, height_m, 0, -90, 15));
    settle(globe, kSlopePicture);
    const View view = globe.view(kSlopePicture);
    const glm::dvec3 sun = glm::normalize(glm::normalize(view.eye.xyz_m) - 0.45 * view.right + 0.35 * view.up);
    const double exaggeration = globe.options().exaggeration;
    const Picture seen = picture();
    Levels levels;
    for (int k = 0; k < kSlopePicture.width_px * kSlopePicture.height_px; ++k) {
      const int x = k % kSlopePicture.width_px, y = k / kSlopePicture.width_px;
      const auto place = pick(view, globe.ground(), {x + 0.5, y + 0.5});
      EXPECT_TRUE(place);
      const double lat = place->lat.rad(), lon = place->lon.rad();
      const glm::dvec3 up = Ellipsoid::normal(place->lat, place->lon).xyz, east(-std::sin(lon), std::cos(lon), 0.0);
      const glm::dvec3 north = glm::cross(up, east);
      const glm::dvec3 light = globe.options().surface.hillshade
                                   ? glm::dvec3(-0.5, 0.5, std::sqrt(0.5))
                                   : glm::dvec3(glm::dot(east, sun), glm::dot(north, sun), glm::dot(up, sun));
      const double factor = light_factor(exaggeration * slope_at(lat, lon), light);
      levels.truth.push_back(std::round(std::min(255.0, kSlopeGround[0] * factor)));
      levels.seen.push_back(seen.at(x, y)[0]);
    }
    return levels;
  }
};

TEST_F(ReliefLight, IsThatOfTheNormalsWithoutFacetsHoweverExaggerated) {
  // Half a per cent of the light: rounding, and places that a mesh within half a pixel of the ground shows.
  constexpr double kMean_levels = 3.0;
  constexpr double kBend = 0.2;
  for (const bool hillshade : {false, true}) {
    for (const double exaggeration : {1.0, 5.0, 20.0}) {
      GlobeOptions options;
      options.exaggeration = exaggeration;
      options.surface.hillshade = hillshade;
      const auto globe = waves(options);
      // Heights 2 pixels apart, as a view takes them; and 5 pixels apart, where there are no finer ones.
      for (const double height_m : {2.5e6, 1.0e6}) {
        const Levels light = levels(*globe, height_m);
        SCOPED_TRACE(testing::Message() << exaggeration << " times from " << height_m
                                        << (hillshade ? " hillshade" : ""));
        EXPECT_LE(light.mean_error(), kMean_levels);
        EXPECT_NEAR(Levels::bend(light.seen) / Levels::bend(light.truth), 1.0, kBend) << "facets";
      }
    }
  }
}

TEST_F(ReliefLight, LeavesNoSlopeBlackAndAnUnlitGroundAlone) {
  GlobeOptions options;
  options.exaggeration = 100.0;
  const Levels steep = levels(*waves(options), 2.5e6);
  EXPECT_GE(*std::ranges::min_element(steep.seen), 0.35 * kSlopeGround[0]);
  options.unlit = true;
  options.exaggeration = 20.0;
  const Levels unlit = levels(*waves(options), 2.5e6);
  EXPECT_EQ(*std::ranges::min_element(unlit.seen), double{kSlopeGround[0]});
}

}  // namespace
}  // namespace terrella::test
