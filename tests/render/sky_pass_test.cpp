// The sky as pixels: stars, Sun and Moon where an ephemeris puts them and as bright, the air around the globe and no
// further.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "sky_scene.h"

namespace terrella::test {
namespace {

constexpr Viewport kSky{200, 160};
constexpr const char* kSolstice = "2026-06-21T12:00:00Z";

Camera looking(double lat, double lon, double height_m, double heading, double pitch, double fov) {
  return {.eye = {.lat = Angle::degrees(lat), .lon = Angle::degrees(lon), .height_m = height_m},
          .heading = Angle::degrees(heading),
          .pitch = Angle::degrees(pitch),
          .fov_y = Angle::degrees(fov)};
}

/// Light of a pixel, 0...1 for each colour together 0...3.
double light_at(const std::vector<std::uint8_t>& picture, int x, int y) {
  double sum = 0.0;
  for (int k = 0; k < 3; ++k) {
    const double c = picture[static_cast<std::size_t>(4 * (y * kSky.width_px + x) + k)] / 255.0;
    sum += c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
  }
  return sum;
}

int channel_at(const std::vector<std::uint8_t>& picture, int x, int y, int k) {
  return picture[static_cast<std::size_t>(4 * (y * kSky.width_px + x) + k)];
}

/// All the light of a picture and where its middle is.
struct Spot {
  double light = 0.0;
  glm::dvec2 center_px{0.0};
  int pixels = 0;  ///< brighter than `threshold`
};
Spot spot_of(const std::vector<std::uint8_t>& picture, double threshold = 0.0) {
  Spot spot;
  for (int y = 0; y < kSky.height_px; ++y) {
    for (int x = 0; x < kSky.width_px; ++x) {
      const double light = light_at(picture, x, y);
      if (light <= threshold) continue;
      spot.light += light;
      spot.center_px += light * glm::dvec2(x + 0.5, y + 0.5);
      ++spot.pixels;
    }
  }
  if (spot.light > 0.0) spot.center_px /= spot.light;
  return spot;
}

SkyInput only(std::string_view utc, bool stars, bool sun, bool moon, bool atmosphere) {
  SkyInput input = sky_at(utc);
  input.stars = stars;
  input.sun = sun;
  input.moon = moon;
  input.atmosphere = atmosphere;
  return input;
}

Star star_towards(const SkyInput& input, const glm::dvec3& ecef, float magnitude) {
  return {glm::vec3(glm::transpose(input.almanac.ecef_from_j2000) * ecef), magnitude, glm::vec3(1.0F)};
}

glm::dvec2 direction_px(const View& view, const glm::dvec3& direction) {
  return *project(view, Ecef{view.eye.xyz_m + 1e9 * direction});
}

TEST(SkyPass, PutsStarsWhereTheyAre) {
  constexpr double kStar_px = 0.3;  // a spot of 8-bit levels; the promise is 1
  const SkyInput input = only(kSolstice, true, false, false, false);
  struct Sight {
    Camera camera;
    glm::dvec2 pixel;
  };
  for (const auto& [camera, pixel] :
       {Sight{looking(10, 20, 2e7, 30, 80, 60), {100.5, 80.5}}, Sight{looking(-80, 200, 1e5, 0, 20, 10), {31.2, 20.9}},
        Sight{looking(0, 0, 2.0, 120, 45, 100), {180.0, 40.75}},
        Sight{looking(90, 0, 1e8, 0, 90, 40), {150.25, 120.0}}}) {
    const View view = make_view(camera, earth().ellipsoid, kSky);
    SkyScene scene(earth(), kSky, {star_towards(input, pixel_ray(view, pixel).xyz, 1.0F)});
    const Spot spot = spot_of(scene.draw(camera, input));
    ASSERT_GT(spot.light, 0.1);
    EXPECT_LE(glm::distance(spot.center_px, pixel), kStar_px) << pixel.x << ',' << pixel.y;
  }
}

TEST(SkyPass, MakesStarsAsBrightAsTheyAre) {
  // Share of the expected light; 8 bits lose a faint spot's border.
  constexpr double kBrightness = 0.12;
  const SkyInput input = only(kSolstice, true, false, false, false);
  const Camera camera = looking(0, 0, 2e7, 0, 90, 40);
  const View view = make_view(camera, earth().ellipsoid, kSky);
  const glm::dvec3 direction = pixel_ray(view, {100.3, 80.4}).xyz;
  double before = 0.0;
  for (float magnitude = -1.5F; magnitude < 5.0F; magnitude += 1.5F) {
    SkyScene scene(earth(), kSky, {star_towards(input, direction, magnitude)});
    const double light = spot_of(scene.draw(camera, input)).light;
    if (before > 0.0) {
      const double ratio = std::pow(10.0, 0.4 * 1.5);
      EXPECT_NEAR(before / light, ratio, ratio * kBrightness) << magnitude;
    }
    before = light;
  }
}

TEST(SkyPass, HidesStarsBehindTheGlobeAndByDay) {
  const SkyInput input = only(kSolstice, true, false, false, true);
  const Camera down = looking(10, 20, 2e7, 0, -90, 15);
  const View view = make_view(down, earth().ellipsoid, kSky);
  SkyScene behind(earth(), kSky, {star_towards(input, pixel_ray(view, {100.5, 80.5}).xyz, -1.0F)});
  EXPECT_EQ(spot_of(behind.draw(down, input)).light, 0.0);
  const Camera up = looking(10, 0, 2.0, 0, 90, 30);
  const View above = make_view(up, earth().ellipsoid, kSky);
  const std::vector<Star> zenith = {star_towards(input, pixel_ray(above, {100.5, 80.5}).xyz, -1.0F)};
  SkyScene noon(earth(), kSky, zenith);
  const auto day = noon.draw(up, input);
  EXPECT_EQ(noon.draw_calls(), 1) << "stars were drawn by day";
  EXPECT_NEAR(light_at(day, 100, 80), light_at(day, 90, 80), 0.01);
  EXPECT_GT(channel_at(day, 100, 80, 2), channel_at(day, 100, 80, 0) + 40) << "the sky is not blue";
  SkyScene night(earth(), kSky, {});
  EXPECT_EQ(spot_of(night.draw(looking(10, 180, 2.0, 0, 60, 30), sky_at(kSolstice))).light, 0.0);
}

TEST(SkyPass, PutsTheSunWhereItIs) {
  // Overhead at 23.43785°N 0.45432°E (ERFA 2.0), of 0.5246° diameter at 1.016203 au.
  constexpr double kFov_deg = 4.0;
  constexpr double kPlace_px =
      1.5;  // the almanac's 0.005° are 0.2 px, the ellipsoid's zenith is where the Sun is overhead
  const SkyInput input = only(kSolstice, false, true, false, false);
  SkyScene scene(earth(), kSky, {});
  const auto picture = scene.draw(looking(23.43785, 0.45432, 1e7, 0, 90, kFov_deg), input);
  const Spot disc = spot_of(picture, 2.5);
  EXPECT_LE(glm::distance(disc.center_px, {100.0, 80.0}), kPlace_px);
  const double radius_px = 0.5 * 0.5246 / kFov_deg * kSky.height_px;
  // The darkened rim and the antialiased pixels around it: 1.5 px.
  EXPECT_NEAR(std::sqrt(disc.pixels / 3.14159265), radius_px, 1.5);
}

struct MoonPhase {
  const char* time;
  double lit;  ///< part of the disc
  friend void PrintTo(const MoonPhase& one, std::ostream* out) { *out << one.time; }
};

// Instants of the phases in April 2024, from almanacs in print.
class SkyMoon : public testing::TestWithParam<MoonPhase> {};
TEST_P(SkyMoon, ShowsItsPhaseTowardsTheSun) {
  constexpr double kLit = 0.04;  // the terminator's own pixels, of a disc 60 px across
  const SkyInput input = only(GetParam().time, false, false, true, false);
  const Geodetic below = Ellipsoid::lat_lon({glm::normalize(input.almanac.moon.xyz_m)});
  Camera camera = looking(below.lat.deg(), below.lon.deg(), 1e6, 0, 90, 1.4);
  SkyScene scene(earth(), kSky, {});
  const auto picture = scene.draw(camera, input);
  const View view = scene.view(camera);
  const glm::dvec3 to_moon = input.almanac.moon.xyz_m - view.eye.xyz_m;
  const glm::dvec2 center = direction_px(view, glm::normalize(to_moon));
  const double radius_px = std::asin(kMoonRadius_m / glm::length(to_moon)) * view.pixels_per_radian();
  const Spot lit = spot_of(picture, 0.05);
  EXPECT_NEAR(lit.pixels / (3.14159265 * radius_px * radius_px), GetParam().lit, kLit);
  if (GetParam().lit > 0.3 && GetParam().lit < 0.7) {
    const glm::dvec3& sun = input.almanac.sun.xyz;
    const glm::dvec2 sunward(glm::dot(sun, view.right), -glm::dot(sun, view.up));
    EXPECT_GT(glm::dot(glm::normalize(lit.center_px - center), glm::normalize(sunward)), 0.99);
  }
}
INSTANTIATE_TEST_SUITE_P(April2024, SkyMoon,
                         testing::Values(MoonPhase{"2024-04-08T18:21:00Z", 0.0}, MoonPhase{"2024-04-15T19:13:00Z", 0.5},
                                         MoonPhase{"2024-04-23T23:49:00Z", 1.0},
                                         MoonPhase{"2024-05-01T11:27:00Z", 0.5}));

TEST(SkyPass, TheFullMoonIsFlat) {
  const SkyInput input = only("2024-04-23T23:49:00Z", false, false, true, false);
  const Geodetic below = Ellipsoid::lat_lon({glm::normalize(input.almanac.moon.xyz_m)});
  const Camera camera = looking(below.lat.deg(), below.lon.deg(), 1e6, 0, 90, 0.8);
  SkyScene scene(earth(), kSky, {});
  const auto seen = scene.draw(camera, input);
  const View view = scene.view(camera);
  const glm::dvec3 to_moon = input.almanac.moon.xyz_m - view.eye.xyz_m;
  const glm::dvec2 center = direction_px(view, glm::normalize(to_moon));
  const double radius_px = std::asin(kMoonRadius_m / glm::length(to_moon)) * view.pixels_per_radian();
  const auto ring = [&](double from, double to) {
    double sum = 0.0;
    int n = 0;
    for (int k = 0; k < kSky.width_px * kSky.height_px; ++k) {
      const glm::dvec2 p(k % kSky.width_px + 0.5, k / kSky.width_px + 0.5);
      const double r = glm::distance(p, center) / radius_px;
      if (r < from || r > to) continue;
      sum += light_at(seen, k % kSky.width_px, k / kSky.width_px);
      ++n;
    }
    return sum / n;
  };
  // A ball of chalk has a rim of a third.
  EXPECT_NEAR(ring(0.85, 0.95) / ring(0.0, 0.3), 1.0, 0.06);
}

TEST(SkyPass, ShowsFaintStarsAndTheirColours) {
  const SkyInput input = only(kSolstice, true, false, false, false);
  const Camera camera = looking(0, 0, 2e7, 0, 90, 40);
  const View view = make_view(camera, earth().ellipsoid, kSky);
  const glm::dvec3 direction = pixel_ray(view, {100.5, 80.5}).xyz;
  const auto peak = [&](float magnitude, double bv) {
    Star star = star_towards(input, direction, magnitude);
    star.color_linear = star_color_linear(bv);
    SkyScene scene(earth(), kSky, {star});
    const auto seen = scene.draw(camera, input);
    return std::pair(channel_at(seen, 100, 80, 0), channel_at(seen, 100, 80, 2));
  };
  // A screen in a lit room shows 30 of 255 beside black.
  EXPECT_GE(peak(4.0F, 0.3).first, 90);
  EXPECT_GE(peak(6.0F, 0.3).first, 30);
  const auto [red, red_blue] = peak(1.0F, 1.8);
  EXPECT_GT(red, red_blue + 60) << "Betelgeuse";
  const auto [blue_red, blue] = peak(2.0F, -0.2);
  EXPECT_GT(blue, blue_red + 20) << "a star of Orion's belt";
}

TEST(SkyPass, RimsTheGlobeWithBlueAndNothingBeyond) {
  constexpr double kEmpty_m = 100e3;
  for (const double height_m : {300e3, 2e6}) {
    const Camera camera = looking(20, 0, height_m, 0, height_m > 1e6 ? -40 : -17, height_m > 1e6 ? 8 : 12);
    SkyScene scene(earth(), kSky, {});
    const auto picture = scene.draw(camera, only(kSolstice, false, false, false, true));
    const View view = scene.view(camera);
    const double a = earth().ellipsoid.a_m();
    int blue = 0, empty = 0;
    for (int y = 0; y < kSky.height_px; ++y) {
      const EcefDir ray = pixel_ray(view, {100.5, y + 0.5});
      const glm::dvec3 stretch(1.0, 1.0, a / earth().ellipsoid.b_m());
      const glm::dvec3 eye = view.eye.xyz_m * stretch, along = glm::normalize(ray.xyz * stretch);
      const double lowest_m = glm::length(glm::cross(eye, along)) - a;
      if (lowest_m > kEmpty_m) {
        EXPECT_EQ(light_at(picture, 100, y), 0.0) << lowest_m;
        ++empty;
      }
      if (lowest_m > 20e3 && lowest_m < 40e3) {
        EXPECT_GT(channel_at(picture, 100, y, 2), channel_at(picture, 100, y, 0) + 10) << lowest_m;
        ++blue;
      }
      if (lowest_m < 0.0) {
        EXPECT_EQ(light_at(picture, 100, y), 0.0) << "over the globe";
      }
    }
    EXPECT_GT(blue, 1);
    EXPECT_GT(empty, 5);
  }
}

TEST(SkyPass, LeavesDepthAloneAndDrawsOnlyWhatIsOn) {
  SkyScene scene(earth(), kSky, {star_towards(sky_at(kSolstice), {1, 0, 0}, 1.0F)});
  const Camera camera = looking(20, 100, 5e6, 0, -50, 60);
  static_cast<void>(scene.draw(camera, sky_at(kSolstice)));
  EXPECT_EQ(scene.draw_calls(), 4);
  for (const float depth : scene.depth()) ASSERT_FLOAT_EQ(depth, SkyScene::kDepth);
  EXPECT_EQ(spot_of(scene.draw(camera, only(kSolstice, false, false, false, false))).light, 0.0);
  EXPECT_EQ(scene.draw_calls(), 0);
  SkyScene moon(*parse_body("moon"), kSky, {});
  static_cast<void>(moon.draw(camera, sky_at(kSolstice)));
  EXPECT_EQ(moon.draw_calls(), 1) << "the Moon has the Sun in its sky, and neither air nor a Moon";
}

}  // namespace
}  // namespace terrella::test
