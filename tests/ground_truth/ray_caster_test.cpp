#include "apps/bench/truth/ray_caster.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <numeric>
#include <random>

#include "apps/bench/truth/noise_planet.h"

namespace terrella::truth {
namespace {

constexpr double kRadiansPerDegree = std::numbers::pi / 180.0;
constexpr Spheroid kSphere{6371000.0, 0.0};
constexpr Spheroid kSaturn{60268000.0, 0.098};
constexpr double kTexel = 1e-9;      // texels: a 8192-texel row in double is good to 1e-12 of itself
constexpr double kNadir_deg = 1e-9;  // the eye's own rounding at 1e8 m, seen from the surface: 1e-8 m
constexpr double kFloat_deg = 2e-5;  // zone arrays are float: 1 ulp of 180° is 1.5e-5

Picture filled(int width, int height, std::uint8_t level) {
  Picture picture{width, height, {}};
  picture.rgb.assign(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height), level);
  return picture;
}

double limb_radius_px(double radius_m, double distance_m, double fov_deg, int height_px) {
  return 0.5 * height_px * std::tan(std::asin(radius_m / distance_m)) / std::tan(0.5 * fov_deg * kRadiansPerDegree);
}

TEST(PixelRaysTest, TheCentreOfANadirViewIsTheSubPoint) {
  std::mt19937 engine(11);
  const auto uniform = [&](double low, double high) { return std::uniform_real_distribution<>(low, high)(engine); };
  for (int i = 0; i < 500; ++i) {
    const Place eye{uniform(-89.9, 89.9), uniform(-180, 180), std::pow(10.0, uniform(1, 8))};
    const PixelRays rays(kSaturn, {.eye = eye, .heading_deg = uniform(0, 360)}, 640, 480);
    const auto hit = first_hit(kSaturn, rays.eye_m(), rays.direction({320, 240}));
    ASSERT_TRUE(hit);
    const double east = std::remainder(longitude_rad(hit->normal) / kRadiansPerDegree - eye.lon_deg, 360.0);
    EXPECT_NEAR(latitude_rad(hit->normal) / kRadiansPerDegree, eye.lat_deg, kNadir_deg);
    EXPECT_NEAR(east * std::cos(eye.lat_deg * kRadiansPerDegree), 0.0, kNadir_deg);
  }
}

TEST(PixelRaysTest, HeadingSaysWhichWayIsUpInANadirView) {
  const Place eye{0.0, 0.0, 1e6};
  const auto place_at = [&](double heading, glm::dvec2 pixel) {
    const PixelRays rays(kSphere, {.eye = eye, .heading_deg = heading}, 100, 100);
    return first_hit(kSphere, rays.eye_m(), rays.direction(pixel))->normal;
  };
  EXPECT_GT(latitude_rad(place_at(0, {50, 25})), 0.0) << "north is up";
  EXPECT_GT(longitude_rad(place_at(0, {75, 50})), 0.0) << "east is right";
  EXPECT_GT(longitude_rad(place_at(90, {50, 25})), 0.0) << "east is up";
  EXPECT_LT(latitude_rad(place_at(90, {75, 50})), 0.0) << "south is right";
}

TEST(PixelRaysTest, PitchTiltsUpFromTheHorizontal) {
  const PixelRays level(kSphere, {.eye = {0, 0, 1e6}, .heading_deg = 90, .pitch_deg = 0}, 100, 100);
  const glm::dvec3 east = level.direction({50, 50});
  EXPECT_NEAR(east.x, 0.0, kNadir_deg);
  EXPECT_NEAR(east.y, 1.0, kNadir_deg);
  const PixelRays zenith(kSphere, {.eye = {0, 0, 1e6}, .pitch_deg = 90}, 100, 100);
  EXPECT_NEAR(zenith.direction({50, 50}).x, 1.0, kNadir_deg);
}

TEST(PixelRaysTest, FieldOfViewIsVertical) {
  const PixelRays rays(kSphere, {.eye = {0, 0, 1e6}, .pitch_deg = 0, .fov_deg = 90}, 200, 100);
  const glm::dvec3 top = rays.direction({100, 0});
  EXPECT_NEAR(top.x, 1.0, kNadir_deg);
  EXPECT_NEAR(top.z, 1.0, kNadir_deg);
  EXPECT_NEAR(rays.direction({200, 50}).y, 2.0, kNadir_deg) << "twice as wide as tall";
}

TEST(CastTest, TheDiscHasTheClosedFormsRadius) {
  const TruthCamera camera{.eye = {20, 30, 3 * kSphere.a_m}};
  const TruthImage image = cast(filled(8, 4, 255), {}, kSphere, camera, {.width = 256, .height = 256});
  const double area = std::accumulate(image.hits.begin(), image.hits.end(), 0.0) / image.rays_per_pixel;
  constexpr double kRadius_px = 0.01;  // 64 rays a pixel over a rim of 570 pixels: far below a hundredth
  EXPECT_NEAR(std::sqrt(area / std::numbers::pi), limb_radius_px(kSphere.a_m, 4 * kSphere.a_m, 40, 256), kRadius_px);
  EXPECT_EQ(image.hits[0], 0);
  EXPECT_TRUE(std::isnan(image.lat_deg[0]));
  EXPECT_EQ(image.rgb[0], 0.0F) << "background is black";
}

TEST(CastTest, ARimPixelsLevelIsItsCoverage) {
  const TruthCamera camera{.eye = {0, 0, 3 * kSphere.a_m}};
  const TruthImage image = cast(filled(8, 4, 200), {}, kSphere, camera, {.width = 64, .height = 64});
  int rim = 0;
  for (std::size_t i = 0; i < image.hits.size(); ++i) {
    EXPECT_FLOAT_EQ(image.rgb[3 * i], 200.0F * static_cast<float>(image.hits[i]) / 64.0F);
    rim += image.hits[i] > 0 && !image.covered(i);
  }
  EXPECT_GT(rim, 100);
}

TEST(CastTest, ZonesAreTheCentresPlace) {
  const TruthCamera camera{.eye = {46, 7, 300000}, .heading_deg = 30, .pitch_deg = -20, .fov_deg = 45};
  const TruthImage image = cast(filled(8, 4, 200), {}, Spheroid{}, camera, {.width = 33, .height = 21});
  const PixelRays rays(Spheroid{}, camera, 33, 21);
  const std::size_t at = 18 * 33 + 16;
  const glm::dvec3 direction = rays.direction({16.5, 18.5});
  const auto hit = first_hit(Spheroid{}, rays.eye_m(), direction);
  ASSERT_TRUE(hit);
  EXPECT_NEAR(image.lat_deg[at], latitude_rad(hit->normal) / kRadiansPerDegree, kFloat_deg);
  EXPECT_NEAR(image.lon_deg[at], longitude_rad(hit->normal) / kRadiansPerDegree, kFloat_deg);
  const double cosine = -glm::dot(direction, hit->normal) / glm::length(direction);
  EXPECT_NEAR(std::cos(static_cast<double>(image.incidence_deg[at]) * kRadiansPerDegree), cosine, kFloat_deg);
}

TEST(CastTest, TheNumberOfThreadsChangesNothing) {
  const Picture source = noise_planet({.width = 256, .height = 128});
  const TruthCamera camera{.eye = {88, 10, 6e6}};
  const TruthImage one = cast(source, {}, Spheroid{}, camera, {.width = 40, .height = 30, .threads = 1});
  const TruthImage three = cast(source, {}, Spheroid{}, camera, {.width = 40, .height = 30, .threads = 3});
  EXPECT_EQ(one.rgb, three.rgb);
}

TEST(TexelPositionTest, RowsFollowTheLatitudeTheyCount) {
  const Picture source = filled(3600, 1800, 0);
  for (double lat = -89.5; lat < 90; lat += 0.7) {
    const glm::dvec3 normal = local_frame(lat, 40).up;
    const Hit hit{position_m(kSaturn, {lat, 40, 0}), normal, 1.0};
    // tan(centric) = (1 - f)² tan(geodetic), the textbook's relation.
    const double centric =
        std::atan((1 - kSaturn.f) * (1 - kSaturn.f) * std::tan(lat * kRadiansPerDegree)) / kRadiansPerDegree;
    const auto row = [&](bool area, bool centre) { return texel_position(source, {area, centre}, hit).y; };
    EXPECT_NEAR(row(false, false), (90 - lat) * 10, kTexel);
    EXPECT_NEAR(row(false, true), (90 - centric) * 10, kTexel);
    EXPECT_NEAR(row(true, false), 900 * (1 - std::sin(lat * kRadiansPerDegree)), kTexel);
    EXPECT_NEAR(row(true, true), 900 * (1 - std::sin(centric * kRadiansPerDegree)), kTexel);
    EXPECT_NEAR(texel_position(source, {}, hit).x, 2200, kTexel);
  }
}

TEST(SampleTest, TexelCentresAreAtHalvesAndLongitudeWraps) {
  Picture source = filled(4, 2, 0);
  for (int y = 0; y < 2; ++y) {
    for (int x = 0; x < 4; ++x)
      source.rgb[static_cast<std::size_t>(3 * (4 * y + x))] = static_cast<std::uint8_t>(100 * y + 10 * x);
  }
  EXPECT_EQ(sample(source, {2.5, 0.5}).x, 20);
  EXPECT_EQ(sample(source, {3.0, 0.5}).x, 25);
  EXPECT_EQ(sample(source, {2.5, 1.0}).x, 70);
  EXPECT_EQ(sample(source, {0.0, 0.5}).x, 15) << "between the last column and the first";
  EXPECT_EQ(sample(source, {4.0, 0.5}).x, 15) << "the same place from the other side";
  EXPECT_EQ(sample(source, {2.5, 0.0}).x, 20) << "over the pole the first row goes on";
  EXPECT_EQ(sample(source, {2.5, 2.0}).x, 120);
}

}  // namespace
}  // namespace terrella::truth
