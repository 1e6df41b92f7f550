// Light on relief, against the light of the analytic normals where rays meet the ground.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <map>
#include <numbers>

#include "tests/gl/gl_fixture.h"
#include "tests/gl/painted_heights.h"
#include "tests/scene/patch_test_support.h"

namespace terrella::test {
namespace {

constexpr Color kSlopeGround = {150, 150, 150};
constexpr Viewport kSlopePicture{128, 128};
constexpr double kSector_deg = 15.0;
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

/// Heights at a pole, and their rise per metre towards east and north by their own derivatives.
struct PoleShape {
  const char* name;
  HeightPaint height_m;
  glm::dvec2 (*slope)(double lat, double lon);
};

// Patches at a pole are 90° wide and take at most six tiles a row: larger tiles, so that all patches take the finest.
const TileGrid kPoleHeights{.tile_px = 256, .max_level = 3};
constexpr double kPole_m = 6000.0, kTilted = 8.0, kBowl = 40.0;  // waves per radian of polar distance

double hemisphere(double lat) { return lat > 0.0 ? 1.0 : -1.0; }
double polar_distance(double lat) { return 0.5 * std::numbers::pi - std::abs(lat); }

/// A plane through the pole, which bends back further out; its slope has one direction.
double tilted_m(double lat, double lon) {
  return kPole_m * std::sin(kTilted * std::sin(polar_distance(lat)) * std::cos(lon - 0.4));
}
glm::dvec2 tilted_slope(double lat, double lon) {
  const double away = polar_distance(lat), turn = lon - 0.4;
  const double rise = kPole_m * kTilted * std::cos(kTilted * std::sin(away) * std::cos(turn)) / earth().ellipsoid.a_m();
  return {-rise * std::sin(turn), -hemisphere(lat) * rise * std::cos(away) * std::cos(turn)};
}

/// A round mountain on the pole: its slopes point in all directions.
double mountain_m(double lat, double /*lon*/) { return kPole_m * std::cos(kBowl * polar_distance(lat)); }
glm::dvec2 mountain_slope(double lat, double /*lon*/) {
  const double fall = kPole_m * kBowl * std::sin(kBowl * polar_distance(lat)) / earth().ellipsoid.a_m();
  return {0.0, hemisphere(lat) * fall};
}

const PoleShape kPoleShapes[] = {{"tilted", tilted_m, tilted_slope}, {"mountain", mountain_m, mountain_slope}};

/// The light of a slope as a factor of level ground's: 1.3 times the change of the light's sine, at most ±0.6.
double light_factor(glm::dvec2 slope, const glm::dvec3& light_enu) {
  const glm::dvec3 normal = glm::normalize(glm::dvec3(-slope, 1.0));
  const double gain = 1.3 * (glm::dot(normal, light_enu) - light_enu.z);
  return 1.0 + gain / std::sqrt(1.0 + gain * gain / 0.36);
}

/// Levels of the pixels of a row-major picture.
struct Levels {
  std::vector<double> seen, truth;
  std::vector<double> of_3_deg;  ///< change of the truth if the slope is turned by 3° about the vertical
  std::vector<int> sector;       ///< number of the place's longitude in sectors
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

/// Errors around the picture's middle, levels.
struct PoleErrors {
  double mean = 0.0, of_3_deg = 0.0, worst_sector = 0.0;
};
PoleErrors at_pole(const Levels& light) {
  constexpr double kReach_px = 12.0;
  PoleErrors errors;
  std::map<int, glm::dvec2> sectors;  // sum of the errors, number
  double n = 0.0;
  for (std::size_t k = 0; k < light.seen.size(); ++k) {
    const auto width = static_cast<std::size_t>(kSlopePicture.width_px);
    const glm::dvec2 px(static_cast<double>(k % width) + 0.5, static_cast<double>(k / width) + 0.5);
    if (glm::distance(px, 0.5 * glm::dvec2(kSlopePicture.width_px, kSlopePicture.height_px)) > kReach_px) continue;
    const double error = light.seen[k] - light.truth[k];
    errors.mean += std::abs(error);
    errors.of_3_deg += light.of_3_deg[k];
    sectors[light.sector[k]] += glm::dvec2(error, 1.0);
    n += 1.0;
  }
  errors.mean /= n;
  errors.of_3_deg /= n;
  for (const auto& [sector, sum] : sectors) {
    errors.worst_sector = std::max(errors.worst_sector, std::abs(sum.x / sum.y));
  }
  return errors;
}

class ReliefLight : public GlTest {
 protected:
  static std::unique_ptr<Globe> waves(GlobeOptions options, const TileGrid& grid = kSlopeHeights,
                                      const HeightPaint& height_m = wave_m) {
    options.relief_meshes_per_frame = std::numeric_limits<int>::max();
    auto heights = ElevationSource::open(painted_heights(grid, height_m), "heights");
    auto globe = Globe::create(options, one_colour(kSlopeImagery, kSlopeGround), *heights);
    EXPECT_TRUE(globe);
    return std::move(*globe);
  }
  /// Levels seen and true from straight above, where level ground has its full light.
  Levels levels(Globe& globe, double height_m) {
    return levels(globe, camera_at(10, 20, height_m, 0, -90, 15), slope_at);
  }
  Levels levels(Globe& globe, const Camera& camera, glm::dvec2 (*slope_of)(double, double)) {
    globe.set_camera(camera);
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
      const auto level = [&](glm::dvec2 slope) {
        return std::round(std::min(255.0, kSlopeGround[0] * light_factor(exaggeration * slope, light)));
      };
      const glm::dvec2 slope = slope_of(lat, lon);
      const double turn = 3.0 * std::numbers::pi / 180.0, c = std::cos(turn), s = std::sin(turn);
      levels.truth.push_back(level(slope));
      levels.of_3_deg.push_back(
          std::abs(level({c * slope.x - s * slope.y, s * slope.x + c * slope.y}) - levels.truth.back()));
      levels.sector.push_back(static_cast<int>(std::floor((place->lon.deg() + 180.0) / kSector_deg)));
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

// The triangles that meet at a pole, where east and north turn by up to 45° within one.
TEST_F(ReliefLight, HasNoSectorsAtThePoles) {
  constexpr double kRounding = 0.15;
  for (const PoleShape& shape : kPoleShapes) {
    for (const bool hillshade : {false, true}) {
      GlobeOptions options;
      options.exaggeration = 40.0;
      options.surface.hillshade = hillshade;
      const auto globe = waves(options, kPoleHeights, shape.height_m);
      for (const double lat_deg : {89.99, -89.99}) {
        for (const double height_m : {1.0e6, 3.0e6}) {
          SCOPED_TRACE(testing::Message()
                       << shape.name << " at " << lat_deg << " from " << height_m << (hillshade ? " hillshade" : ""));
          const Levels light = levels(*globe, camera_at(lat_deg, 100, height_m, 30, -90, 15), shape.slope);
          const PoleErrors errors = at_pole(light);
          EXPECT_LE(errors.mean, errors.of_3_deg + kRounding);
          EXPECT_LE(errors.worst_sector, errors.of_3_deg + kRounding) << "a sector is visible";
        }
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
