// The air's table against what a fine numerical integral of the same air says, and against what everyone has seen.
#include "sky/atmosphere.h"

#include <gtest/gtest.h>

#include <cmath>

namespace terrella::test {
namespace {

constexpr double kEarthRadius_m = 6378137.0;
// Light that is less than a quarter of the darkest of 256 levels.
constexpr double kDark = 1e-3;

const Atmosphere& earth_air() {
  static const Atmosphere air = *atmosphere_of(earth());
  return air;
}

SkyTable table_at(double height_m, double sun_elevation_deg) {
  return make_sky_table(earth_air(), kEarthRadius_m, 1.0 + height_m / kEarthRadius_m,
                        std::sin(Angle::degrees(sun_elevation_deg).rad()));
}

glm::vec4 at(const std::vector<glm::vec4>& layer, int row, int column) {
  return layer[static_cast<std::size_t>(row * SkyTable::kColumns + column)];
}

TEST(Atmosphere, BelongsToBodiesThatHaveOne) {
  EXPECT_TRUE(atmosphere_of(earth()));
  EXPECT_TRUE(atmosphere_of(*parse_body("sphere")));
  EXPECT_TRUE(atmosphere_of(*parse_body("mars")));
  for (const char* body : {"moon", "mercury", "phobos", "1000000,0.01"}) EXPECT_FALSE(atmosphere_of(*parse_body(body)));
}

// Straight up the depth is the scale height times the coefficient, up to what lies above the top (1e-5 of it) and 5 %
// for the few samples of a ray.
TEST(Atmosphere, HasTheDepthOfItsGas) {
  const SkyTable table = table_at(0.0, 45.0);
  EXPECT_FALSE(table.outside);
  const glm::vec4 zenith = at(table.transmitted, SkyTable::kRows - 1, 0);
  for (int k = 0; k < 3; ++k) {
    const double depth = earth_air().gas_scatter_per_m[k] * earth_air().gas_scale_m +
                         earth_air().dust_extinct_per_m[k] * earth_air().dust_scale_m;
    EXPECT_NEAR(-std::log(zenith[k]) / depth, 1.0, 0.05);
  }
}

// A ray that touches the ground passes sqrt(2π R H) of the ground's density, to R/H's order; 10 % for the samples.
TEST(Atmosphere, HasTheDepthOfAGrazingRay) {
  const SkyTable table = table_at(300e3, 30.0);
  EXPECT_TRUE(table.outside);
  const auto through = [](double coefficient, double scale_m) {
    return coefficient * std::sqrt(2.0 * 3.14159265 * kEarthRadius_m * scale_m);
  };
  const double depth = through(earth_air().gas_scatter_per_m.r, earth_air().gas_scale_m) +
                       through(earth_air().dust_extinct_per_m.r, earth_air().dust_scale_m);
  EXPECT_NEAR(-std::log(at(table.transmitted, 0, 0).r) / depth, 1.0, 0.1);
}

TEST(Atmosphere, EndsSoftly) {
  const SkyTable table = table_at(300e3, 30.0);
  for (int column = 0; column < SkyTable::kColumns; ++column) {
    const glm::vec4 top = at(table.gas, SkyTable::kRows - 1, column);
    EXPECT_LT(std::max({top.r, top.g, top.b}) * earth_air().exposure, kDark);
    EXPECT_GT(at(table.transmitted, SkyTable::kRows - 1, column).b, 0.999F);
  }
}

TEST(Atmosphere, IsBlueByDayRedAtSunsetAndDarkAtNight) {
  const int zenith = SkyTable::kRows - 1;
  const glm::vec4 noon = at(table_at(0.0, 60.0).gas, zenith, 0);
  EXPECT_GT(noon.b, 2.0F * noon.r);
  const SkyTable evening = table_at(0.0, 0.5);
  const glm::vec4 west = at(evening.gas, 2, 0) + at(evening.dust, 2, 0);
  EXPECT_GT(west.r, 2.0F * west.b);
  const SkyTable night = table_at(0.0, -20.0);
  for (std::size_t k = 0; k < night.gas.size(); ++k) {
    EXPECT_LT((night.gas[k].b + night.dust[k].r) * earth_air().exposure, kDark) << k;
  }
  const float twilight = at(table_at(0.0, -6.0).gas, zenith, 0).b;
  EXPECT_GT(twilight, 0.0F);
  EXPECT_LT(twilight, 0.2F * noon.b);
}

TEST(Atmosphere, IsFiniteEverywhere) {
  for (const char* name : {"earth", "mars"}) {
    const Atmosphere air = *atmosphere_of(*parse_body(name));
    for (const double radius : {0.0, 0.5, 1.0, 1.0 + 1e-12, 1.001, 1.0141, 1.2, 16.0, 1e6}) {
      for (const double sun : {-1.0, -0.2, -1e-9, 0.0, 1e-9, 0.5, 1.0}) {
        const SkyTable table = make_sky_table(air, 3.4e6, radius, sun);
        for (const auto* layer : {&table.gas, &table.dust, &table.transmitted}) {
          ASSERT_EQ(layer->size(), std::size_t(SkyTable::kColumns * SkyTable::kRows));
          for (const glm::vec4& v : *layer) ASSERT_TRUE(v.r >= 0.0F && v.g >= 0.0F && v.b >= 0.0F && v.r < 100.0F);
        }
      }
    }
  }
}

TEST(Atmosphere, LetsStarsOutAsItDarkens) {
  EXPECT_EQ(star_visibility(earth_air(), 0.0, 0.5), 0.0);
  EXPECT_EQ(star_visibility(earth_air(), 0.0, -0.3), 1.0);
  EXPECT_NEAR(star_visibility(earth_air(), 300e3, 1.0), 1.0, 1e-6);
  double before = 0.0;
  for (double sun = 0.0; sun > -0.3; sun -= 0.01) {
    const double now = star_visibility(earth_air(), 0.0, sun);
    EXPECT_GE(now, before);
    before = now;
  }
}

}  // namespace
}  // namespace terrella::test
