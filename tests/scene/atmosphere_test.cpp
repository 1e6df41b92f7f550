// The air's tables against the integrals of the same air, and against what everyone has seen.
#include "sky/atmosphere.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/common.hpp>

#include "sky/air_colors.h"

namespace terrella::test {
namespace {

constexpr double kEarthRadius_m = 6378137.0;
// Less than a quarter of the darkest of 256 levels.
constexpr float kDark = 1e-3F;

const AirTables& earth_tables() {
  static const AirTables tables(*atmosphere_of(earth()), kEarthRadius_m);
  return tables;
}

AirEye eye_at(double height_m, double sun_elevation_deg) {
  return {1.0 + height_m / kEarthRadius_m, std::sin(Angle::degrees(sun_elevation_deg).rad())};
}

glm::vec3 light_at(const SkyTable& table, double azimuth, double row) {
  const AirLight light = table.at(azimuth, row);
  return light.gas + light.dust + light.more;
}

TEST(Atmosphere, BelongsToBodiesThatHaveOne) {
  for (const char* body : {"earth", "sphere", "mars", "titan", "venus"}) EXPECT_TRUE(atmosphere_of(*parse_body(body)));
  for (const char* body : {"moon", "mercury", "phobos", "1000000,0.01"}) EXPECT_FALSE(atmosphere_of(*parse_body(body)));
}

// Straight up the depth is the scale height times the coefficient, and ozone's is its half width times its own.
TEST(Atmosphere, HasTheDepthOfItsGas) {
  const Atmosphere& air = earth_tables().air();
  for (int k = 0; k < 3; ++k) {
    const double depth = air.gas_scatter_per_m[k] * air.gas_scale_m + air.dust_extinct_per_m[k] * air.dust_scale_m +
                         air.ozone_absorb_per_m[k] * air.ozone_half_width_m;
    EXPECT_NEAR(-std::log(earth_tables().vertical()[k]) / depth, 1.0, 0.01);
  }
}

// A level ray passes sqrt(π R H / 2) of the ground's density, to R/H's order. Ozone takes hardly any blue light.
TEST(Atmosphere, HasTheDepthOfALevelRay) {
  const Atmosphere& air = earth_tables().air();
  const auto through = [](double coefficient, double scale_m) {
    return coefficient * std::sqrt(0.5 * 3.14159265 * kEarthRadius_m * scale_m);
  };
  const double depth =
      through(air.gas_scatter_per_m.b, air.gas_scale_m) + through(air.dust_extinct_per_m.b, air.dust_scale_m);
  EXPECT_NEAR(-std::log(earth_tables().transmittance(1.0, 0.0).b) / depth, 1.0, 0.03);
}

TEST(Atmosphere, EndsSoftly) {
  const SkyTable table = make_sky_table(earth_tables(), eye_at(300e3, 30.0));
  EXPECT_TRUE(table.outside);
  const float exposure = static_cast<float>(earth_tables().air().exposure);
  for (const double azimuth : {0.0, 0.5, 1.0}) {
    const glm::vec3 top = light_at(table, azimuth, 1.0) * exposure;
    EXPECT_LT(std::max({top.r, top.g, top.b}), kDark);
  }
  EXPECT_GT(table.transmitted.back().b, 0.999F);
}

TEST(Atmosphere, IsBlueByDayRedAtSunsetAndDarkAtNight) {
  const glm::vec3 noon = light_at(make_sky_table(earth_tables(), eye_at(0.0, 60.0)), 0.5, 1.0);
  EXPECT_GT(noon.b, 2.0F * noon.r);
  const glm::vec3 west = light_at(make_sky_table(earth_tables(), eye_at(0.0, 0.5)), 0.0, 0.05);
  EXPECT_GT(west.r, 2.0F * west.b);
  const float exposure = static_cast<float>(earth_tables().air().exposure);
  const SkyTable night = make_sky_table(earth_tables(), eye_at(0.0, -20.0));
  for (double row = 0.0; row <= 1.0; row += 0.1) {
    const glm::vec3 light = light_at(night, 0.0, row) * exposure;
    EXPECT_LT(std::max({light.r, light.g, light.b}), kDark) << row;
  }
  const glm::vec3 twilight = light_at(make_sky_table(earth_tables(), eye_at(0.0, -6.0)), 0.5, 1.0);
  EXPECT_GT(twilight.b, 0.0F);
  EXPECT_LT(twilight.b, 0.2F * noon.b);
}

// Whoever looks straight down sees the picture's own colours: within a level of 255.
TEST(Atmosphere, LeavesThePictureOfTheGroundStraightDown) {
  for (const double height_m : {1.0, 1e3, 1e5, 1e7, 1e9}) {
    const GroundColors colors = make_ground_colors(earth_tables(), eye_at(height_m, 45.0));
    for (int column = 0; column < GroundColors::kColumns; ++column) {
      const auto k = static_cast<std::size_t>((GroundColors::kRows - 1) * GroundColors::kColumns + column);
      for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(colors.through[k][c], 1.0F, 0.005F) << height_m;
        EXPECT_LT(std::sqrt(colors.light_sq[k][c]), 0.004F) << height_m;
      }
    }
  }
}

TEST(Atmosphere, IsFiniteEverywhere) {
  for (const char* name : {"earth", "mars", "titan", "venus"}) {
    const AirTables tables(*atmosphere_of(*parse_body(name)), parse_body(name)->ellipsoid.a_m());
    for (const double radius : {1.0, 1.0 + 1e-12, 1.001, 1.0141, 1.2, 16.0, 1e6}) {
      for (const double sun : {-1.0, -0.2, -1e-9, 0.0, 1e-9, 0.5, 1.0}) {
        const SkyColors sky = make_sky_colors(tables, {radius, sun}, 0.001);
        for (const glm::vec4& v : sky.light_srgb) ASSERT_TRUE(v.r >= 0.0F && v.g >= 0.0F && v.b >= 0.0F && v.r <= 1.0F);
        const GroundColors ground = make_ground_colors(tables, {radius, sun});
        for (const glm::vec4& v : ground.light_sq)
          ASSERT_TRUE(v.r >= 0.0F && v.g >= 0.0F && v.b >= 0.0F && v.r <= 1.0F);
        for (const glm::vec4& v : ground.through) ASSERT_TRUE(v.r >= -1e-3F && v.g >= -1e-3F && v.b <= 1.01F);
      }
    }
  }
}

TEST(Atmosphere, LetsStarsOutAsItDarkens) {
  const Atmosphere& air = earth_tables().air();
  EXPECT_EQ(star_visibility(air, 0.0, 0.5), 0.0);
  EXPECT_EQ(star_visibility(air, 0.0, -0.3), 1.0);
  EXPECT_NEAR(star_visibility(air, 300e3, 1.0), 1.0, 1e-6);
  double before = 0.0;
  for (double sun = 0.0; sun > -0.3; sun -= 0.01) {
    const double now = star_visibility(air, 0.0, sun);
    EXPECT_GE(now, before);
    before = now;
  }
}

}  // namespace
}  // namespace terrella::test
