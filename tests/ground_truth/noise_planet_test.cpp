#include "apps/bench/truth/noise_planet.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "apps/bench/truth/ray_caster.h"

namespace terrella::truth {
namespace {

constexpr NoisePlanetOptions kSmall{.width = 2048, .height = 1024};

double mean(const Picture& picture, int channel) {
  double sum = 0;
  for (std::size_t i = static_cast<std::size_t>(channel); i < picture.rgb.size(); i += 3) sum += picture.rgb[i];
  return sum / (static_cast<double>(picture.rgb.size()) / 3.0);
}

// Root mean square difference over a step of three equatorial texels on the ground, round a point, in every direction.
double roughness(const Picture& picture, double lat_deg) {
  const double step = 3 * 360.0 / picture.width;
  double sum = 0;
  int count = 0;
  for (int i = 0; i < 20000; ++i) {
    const double lon = -180.0 + 0.018 * i;
    const LocalFrame here = local_frame(lat_deg + 0.0002 * i - 2.0, lon);
    const double bearing = 2.399963 * i;  // the golden angle: all directions, evenly
    const glm::dvec3 there = here.up + std::tan(step * std::numbers::pi / 180.0) *
                                           (std::cos(bearing) * here.north + std::sin(bearing) * here.east);
    const auto look = [&](const glm::dvec3& normal) {
      return sample(picture, texel_position(picture, {}, Hit{normal, normal, 1.0}));
    };
    const glm::dvec3 change = look(here.up) - look(there);
    sum += change.x * change.x;
    ++count;
  }
  return std::sqrt(sum / count);
}

TEST(NoisePlanetTest, IsTheSameEachTimeWhateverTheThreads) {
  NoisePlanetOptions options{.width = 256, .height = 128, .threads = 1};
  const std::uint64_t once = fingerprint(noise_planet(options));
  options.threads = 3;
  EXPECT_EQ(fingerprint(noise_planet(options)), once);
  options.seed = 1;
  EXPECT_NE(fingerprint(noise_planet(options)), once);
}

TEST(NoisePlanetTest, IsAsRoughAtThePolesAsAtTheEquator) {
  const Picture picture = noise_planet(kSmall);
  const double equator = roughness(picture, 0);
  constexpr double kShare = 0.1;  // 20,000 steps, neighbours alike: a few per cent of statistical error
  EXPECT_GT(equator, 10.0);
  for (const double lat : {85.0, 45.0, -45.0, -85.0})
    EXPECT_NEAR(roughness(picture, lat) / equator, 1.0, kShare) << lat;
}

TEST(NoisePlanetTest, HasItsMeanInTheMiddleAndHardlyClips) {
  const Picture picture = noise_planet(kSmall);
  for (int channel = 0; channel < 3; ++channel) EXPECT_NEAR(mean(picture, channel), 127.5, 4.0);
  std::size_t clipped = 0;
  for (const std::uint8_t level : picture.rgb) clipped += level == 0 || level == 255;
  EXPECT_LT(static_cast<double>(clipped), 0.005 * static_cast<double>(picture.rgb.size()));
}

TEST(NoisePlanetTest, ItsChannelsAreIndependent) {
  const Picture picture = noise_planet(kSmall);
  double product = 0, square = 0;
  for (std::size_t i = 0; i < picture.rgb.size(); i += 3) {
    const double red = picture.rgb[i] - 127.5;
    product += red * (picture.rgb[i + 1] - 127.5);
    square += red * red;
  }
  EXPECT_LT(std::abs(product / square), 0.1);
}

}  // namespace
}  // namespace terrella::truth
