// Light on the surface: the Moon's dust, the Sun's glint on the sea, clouds over the ground with their shadow.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "sky/almanac.h"
#include "tests/gl/gl_fixture.h"
#include "tests/scene/patch_test_support.h"

namespace terrella::test {
namespace {

constexpr Viewport kLightPicture{160, 160};
const TileGrid kLightGrid{.tile_px = 64, .max_level = 2};

UtcTime noon() { return *parse_utc("2026-06-21T12:00Z"); }

/// A camera straight over the place where a body's Sun is at the zenith, turned away from it by an angle eastwards.
Camera over_the_sun(double away_deg, double height_m, double fov_deg) {
  const Geodetic below = Ellipsoid::lat_lon(almanac_at(noon())->sun);
  return camera_at(below.lat.deg(), below.lon.deg() + away_deg, height_m, 0, -90, fov_deg);
}

class SurfaceLight : public GlTest {
 protected:
  Picture of(const GlobeOptions& options, const Color& color, const Camera& camera) {
    const auto globe = make_globe(options, one_colour(kLightGrid, color));
    globe->set_camera(camera);
    settle(*globe, kLightPicture);
    return picture();
  }
  /// The light that the glint adds to the red of each pixel, rows from the top; and the camera's view.
  struct Glint {
    std::vector<int> more;
    View view;
    [[nodiscard]] int at(int x, int y) const { return more[static_cast<std::size_t>(y * kLightPicture.width_px + x)]; }
  };
  Glint glint(const GlobeOptions& options, const Color& color, const Camera& camera) {
    const auto globe = make_globe(options, one_colour(kLightGrid, color));
    globe->set_camera(camera);
    settle(*globe, kLightPicture);
    const Picture with = picture();
    globe->set_surface({.glint = false});
    draw(*globe, kLightPicture);
    const Picture without = picture();
    Glint seen{{}, globe->view(kLightPicture)};
    for (std::size_t k = 0; k < with.rgba.size(); k += 4) seen.more.push_back(with.rgba[k] - without.rgba[k]);
    return seen;
  }
};

/// Mean level of a ring around the picture's middle, radii in shares of the disc's.
double ring(const Picture& seen, double radius_px, double from, double to) {
  double sum = 0.0;
  int n = 0;
  for (int y = 0; y < kLightPicture.height_px; ++y) {
    for (int x = 0; x < kLightPicture.width_px; ++x) {
      const double r = std::hypot(x + 0.5 - 80.0, y + 0.5 - 80.0) / radius_px;
      if (r < from || r > to) continue;
      sum += seen.at(x, y)[0];
      ++n;
    }
  }
  return sum / n;
}

TEST_F(SurfaceLight, TheFullMoonIsFlatAndTheEarthIsNotLitLikeIt) {
  GlobeOptions options;
  options.time = noon();
  options.body = *parse_body("moon");
  const double a_m = options.body.ellipsoid.a_m(), distance_m = 40.0 * a_m;
  const double radius_px = 80.0 * std::asin(a_m / distance_m) / std::tan(0.5 * 3.4 * 3.14159265 / 180.0);
  const Camera full = over_the_sun(0.0, distance_m - a_m, 3.4);
  const Picture moon = of(options, {200, 200, 200}, full);
  const double middle = ring(moon, radius_px, 0.0, 0.3), rim = ring(moon, radius_px, 0.85, 0.95);
  // The law's own 1.4° of phase at this distance, and 8 bits.
  EXPECT_NEAR(rim / middle, 1.0, 0.05);
  EXPECT_NEAR(middle, 200.0, 10.0);
  options.body = earth();
  options.body.name = "sphere";
  const Camera far = over_the_sun(0.0, 40.0 * earth().ellipsoid.a_m(), 3.4);
  const Picture ball = of(options, {200, 200, 200}, far);
  // A ring whose Sun stands 12° to 18° high; imagery has its full light from 30° on.
  EXPECT_LT(ring(ball, radius_px, 0.95, 0.98) / ring(ball, radius_px, 0.0, 0.3), 0.95);
}

TEST_F(SurfaceLight, TheHalfMoonFadesTowardsItsTerminatorAndIsDarkBeyond) {
  GlobeOptions options;
  options.time = noon();
  options.body = *parse_body("moon");
  const Picture half = of(options, {200, 200, 200}, over_the_sun(90.0, 39.0 * 1737400.0, 3.4));
  EXPECT_LT(half.at(110, 80)[0], 12);  // the night side keeps a fiftieth
  EXPECT_GT(half.at(30, 80)[0], 100);
  EXPECT_LT(half.at(70, 80)[0], half.at(50, 80)[0]);
}

TEST_F(SurfaceLight, TheSeaMirrorsTheSunWhereAMirrorWouldAndLandDoesNot) {
  GlobeOptions options;
  options.time = noon();
  options.sky = true;
  const Camera camera = over_the_sun(40.0, 2.0e7, 40.0);
  const auto brightening = [&](const Color& color) {
    const Glint seen = glint(options, color, camera);
    // The glint is brightest where the normal halves the angle between Sun and eye.
    const glm::dvec3 sun = almanac_at(noon())->sun.xyz;
    int most = 0;
    double tilt_deg = 180.0;
    for (int k = 0; k < kLightPicture.width_px * kLightPicture.height_px; ++k) {
      const int x = k % kLightPicture.width_px, y = k / kLightPicture.width_px;
      const int more = seen.at(x, y);
      const auto place = pick(seen.view, earth().ellipsoid, {x + 0.5, y + 0.5});
      if (more <= most || !place) continue;
      most = more;
      const glm::dvec3 normal = Ellipsoid::normal(place->lat, place->lon).xyz;
      const glm::dvec3 eye = glm::normalize(seen.view.eye.xyz_m - earth().ellipsoid.position({normal}).xyz_m);
      tilt_deg = std::acos(std::min(1.0, glm::dot(glm::normalize(eye + sun), normal))) * 57.29578;
    }
    return std::pair(most, tilt_deg);
  };
  const auto [sea, tilt_deg] = brightening({10, 30, 80});
  EXPECT_GT(sea, 20) << "no glint";
  EXPECT_LT(tilt_deg, 4.0) << "Fresnel's mirror is brighter a little towards the horizon";
  EXPECT_EQ(brightening({60, 70, 40}).first, 0) << "land glints";
  EXPECT_EQ(brightening({225, 235, 245}).first, 0) << "ice glints";
}

// Sunrise over the sea. The glint is many times as bright as white ground there. A mere limit made one even patch of it
// with an upright edge on each side; a bell is 0.39 times as wide at nine tenths of its height as at half.
TEST_F(SurfaceLight, AGlintUnderALowSunHasNoEdge) {
  constexpr double kWide = 0.6;
  GlobeOptions options;
  options.sky = true;
  options.time = *parse_utc("2026-06-21T23:10Z");
  const Glint seen = glint(options, {10, 30, 80}, camera_at(10.0, 100.0, 4.0e5, 60, -20));
  int rows = 0;
  for (int y = 0; y < kLightPicture.height_px; ++y) {
    int most = 0, high = 0, half = 0;
    for (int x = 0; x < kLightPicture.width_px; ++x) most = std::max(most, seen.at(x, y));
    if (most < 60) continue;
    for (int x = 0; x < kLightPicture.width_px; ++x) {
      high += seen.at(x, y) > 0.9 * most ? 1 : 0;
      half += seen.at(x, y) > 0.5 * most ? 1 : 0;
    }
    EXPECT_LT(high, kWide * half) << "row " << y << " of " << most;
    ++rows;
  }
  EXPECT_GT(rows, 5) << "no glint";
}

TEST_F(SurfaceLight, TheSeaMirrorsNoSunAtAPoleFarFromTheMirror) {
  GlobeOptions options;
  options.time = *parse_utc("2026-06-21T14:00Z");
  options.sky = true;
  for (const double lat_deg : {78.0, 84.0}) {
    const Picture sea = of(options, {10, 30, 80}, camera_at(lat_deg, -20, 1.5e6, 0, -60, 30));
    for (int y = 60; y < kLightPicture.height_px; ++y) {
      for (int x = 2; x < kLightPicture.width_px; ++x) {
        EXPECT_NEAR(sea.at(x, y)[0], sea.at(x - 2, y)[0], 6) << lat_deg << ": " << x << ' ' << y;
      }
    }
  }
}

class SurfaceClouds : public SurfaceLight {
 protected:
  static constexpr double kCloud_m = 2.0e5;  // high, so that their parallax is many pixels
  /// A round cloud, 0.7° to each side of 10°N 20°E over grey ground.
  static std::shared_ptr<PaintedSource> cloud() {
    return std::make_shared<PaintedSource>(TileGrid{.tile_px = 128, .max_level = 3}, [](double lon, double lat) {
      const bool in = std::hypot(lon - 20.0, lat - 10.0) < 0.7;
      return in ? Color{255, 255, 255} : Color{0, 0, 0};
    });
  }
  /// Middle of the pixels that are brighter (or darker) than the bare ground.
  static glm::dvec2 middle_px(const Picture& seen, bool brighter) {
    glm::dvec2 sum{0.0};
    int n = 0;
    for (int k = 0; k < kLightPicture.width_px * kLightPicture.height_px; ++k) {
      const int x = k % kLightPicture.width_px, y = k / kLightPicture.width_px;
      if (brighter ? seen.at(x, y)[0] < 180 : seen.at(x, y)[0] > 85) continue;
      sum += glm::dvec2(x + 0.5, y + 0.5);
      ++n;
    }
    EXPECT_GT(n, 20);
    return sum / std::max(1.0, double(n));
  }
};

TEST_F(SurfaceClouds, StandOverTheGroundWithTheirShadowAwayFromTheSun) {
  const auto globe = make_globe({}, one_colour(kLightGrid, {120, 120, 120}));
  ASSERT_TRUE(globe->add_imagery(cloud(), {.alpha = AlphaFrom::brightness, .height_m = kCloud_m}));
  globe->set_camera(camera_at(4, 20, 2.0e6, 0, -65, 40));
  settle(*globe, kLightPicture);
  const Picture seen = picture();
  const View view = globe->view(kLightPicture);
  const Geodetic place{.lat = Angle::degrees(10), .lon = Angle::degrees(20), .height_m = kCloud_m};
  const Ecef raised = earth().ellipsoid.position(Ellipsoid::normal(place.lat, place.lon), kCloud_m);
  const auto cloud_px = project(view, raised);
  ASSERT_TRUE(cloud_px);
  EXPECT_LT(glm::distance(middle_px(seen, true), *cloud_px), 1.5) << "parallax";
  // The Sun is over the viewer's shoulder. Its ray through the cloud goes on to the ground.
  const glm::dvec3 sun = glm::normalize(glm::normalize(view.eye.xyz_m) - 0.45 * view.right + 0.35 * view.up);
  const auto way = earth().ellipsoid.intersect_m(raised, EcefDir{-sun});
  ASSERT_TRUE(way);
  const auto shadow_px = project(view, Ecef{raised.xyz_m - *way * sun});
  ASSERT_TRUE(shadow_px);
  // The ground is taken as a plane between both, and rims of half a texel are left out.
  EXPECT_LT(glm::distance(middle_px(seen, false), *shadow_px), 2.5) << "shadow";
}

/// Discs, six degrees apart; their rims are soft.
double disc_field(double lon_deg, double lat_deg) {
  const double x = lon_deg - 6.0 * std::round(lon_deg / 6.0), y = lat_deg - 6.0 * std::round(lat_deg / 6.0);
  return std::clamp((2.0 - std::hypot(x, y)) / 0.5, 0.0, 1.0);
}

// Over small patches and tiles shadows reach over many of both. Rays from the ground to the Sun are the truth.
TEST_F(SurfaceClouds, ThrowWholeShadowsOverPatchesAndTiles) {
  constexpr double kHeight_m = 6.0e4;
  GlobeOptions options;
  options.time = noon();
  options.body = *parse_body("sphere");
  const double radius_m = options.body.ellipsoid.a_m();
  const auto globe = make_globe(options, one_colour(kLightGrid, {200, 200, 200}));
  const auto clouds =
      std::make_shared<PaintedSource>(TileGrid{.tile_px = 64, .max_level = 6}, [](double lon, double lat) {
        const auto level = static_cast<std::uint8_t>(std::lround(255.0 * disc_field(lon, lat)));
        return Color{level, level, level};
      });
  const ImageLook look{.alpha = AlphaFrom::brightness, .height_m = kHeight_m};
  const LayerId layer = *globe->add_imagery(clouds, look);
  const glm::dvec3 sun = almanac_at(noon())->sun.xyz;
  // The disc's crossing of a ray from the ground, by longitude and latitude.
  const auto met = [&](const glm::dvec3& ground_m, const glm::dvec3& ray) {
    const double along = glm::dot(ground_m, ray);
    const double way_m = std::sqrt(along * along + kHeight_m * (2.0 * radius_m + kHeight_m)) - along;
    const glm::dvec3 p = glm::normalize(ground_m + way_m * ray);
    return disc_field(std::atan2(p.y, p.x) * 180.0 / std::numbers::pi, std::asin(p.z) * 180.0 / std::numbers::pi);
  };
  int shaded = 0, judged = 0;
  double sum = 0.0;
  for (const double away_deg : {30.0, 60.0, 75.0, 80.0}) {
    globe->set_camera(over_the_sun(away_deg, 1.2e6, 40.0));
    ASSERT_TRUE(globe->set_look(layer, look));
    settle(*globe, kLightPicture);
    const Picture seen = picture();
    ASSERT_TRUE(globe->set_look(layer, {.shown = false}));
    settle(*globe, kLightPicture);
    const Picture bare = picture();
    const glm::dvec3 eye_m = globe->view(kLightPicture).eye.xyz_m;
    for (int y = 1; y < kLightPicture.height_px; y += 2) {
      for (int x = 1; x < kLightPicture.width_px; x += 2) {
        const auto place = globe->pick({x + 0.5, y + 0.5}, kLightPicture).place;
        if (!place) continue;
        const glm::dvec3 ground_m = radius_m * Ellipsoid::normal(place->lat, place->lon).xyz;
        const double sine = glm::dot(ground_m, sun) / radius_m, t = std::clamp(sine / 0.2, 0.0, 1.0);
        if (met(ground_m, glm::normalize(eye_m - ground_m)) > 0.0) continue;  // a cloud hides the ground
        const double cloud = met(ground_m, sun), shade = 0.5 * t * t * (3.0 - 2.0 * t) * cloud;
        const double off = std::abs(seen.at(x, y)[0] - (1.0 - shade) * bare.at(x, y)[0]);
        // A rim of half a degree has 12 pixels and 90 levels: three pixels, of a texel and the plane map.
        EXPECT_LT(off, 24.0) << away_deg << ": " << x << ' ' << y;
        sum += off;
        ++judged;
        shaded += cloud > 0.9 ? 1 : 0;
      }
    }
  }
  EXPECT_GT(shaded, 500);
  EXPECT_LT(sum / judged, 0.5);
}

// Clouds over the limb hide the sky behind them, and the ground's limb shows no line through them.
TEST_F(SurfaceClouds, StandWhiteOverTheLimb) {
  GlobeOptions options;
  options.sky = true;
  const auto globe = make_globe(options, one_colour(kLightGrid, {60, 90, 50}));
  ASSERT_TRUE(
      globe->add_imagery(one_colour(kLightGrid, {255, 255, 255}), {.alpha = AlphaFrom::brightness, .height_m = 1.2e4}));
  globe->set_camera(camera_at(10, 10, 4.0e5, 0, -19.5, 4));
  settle(*globe, kLightPicture);
  const Picture seen = picture();
  for (int x = 8; x < kLightPicture.width_px; x += 16) {
    int y = 0;
    while (y < kLightPicture.height_px && seen.at(x, y)[1] < 180) ++y;
    ASSERT_GT(y, 20) << "no sky";
    ASSERT_LT(y, 100) << "no clouds";
    for (y += 2; y < kLightPicture.height_px; ++y) {  // without the pixel that is mixed with sky
      const Color here = seen.at(x, y), over = seen.at(x, y - 1);
      EXPECT_LT(std::max({here[0], here[1], here[2]}) - std::min({here[0], here[1], here[2]}), 40) << x << ' ' << y;
      // The light changes by a level a pixel there, and dithering by one more.
      EXPECT_NEAR(here[1], over[1], 3) << x << ' ' << y;
    }
  }
}

TEST_F(SurfaceClouds, LieOnTheGroundUnlitAndAtNoHeight) {
  const auto picture_of = [&](GlobeOptions options, double height_m) {
    const auto globe = make_globe(options, one_colour(kLightGrid, {120, 120, 120}));
    EXPECT_TRUE(globe->add_imagery(cloud(), {.alpha = AlphaFrom::brightness, .height_m = height_m}));
    globe->set_camera(camera_at(4, 20, 2.0e6, 0, -65, 40));
    settle(*globe, kLightPicture);
    return picture().rgba;
  };
  EXPECT_EQ(picture_of(unlit_options(), kCloud_m), picture_of(unlit_options(), 0.0));
  EXPECT_NE(picture_of({}, kCloud_m), picture_of({}, 0.0));
}

}  // namespace
}  // namespace terrella::test
