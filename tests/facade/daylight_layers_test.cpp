// Layers that show on one side of the terminator, and layers whose brightness is their alpha.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "surface/daylight.h"
#include "tests/gl/gl_fixture.h"
#include "tests/gl/layer_source.h"
#include "tests/gl/painted_heights.h"
#include "tests/scene/patch_test_support.h"

namespace terrella::test {
namespace {

constexpr Viewport kSides{96, 96};
const TileGrid kSidesGrid{.tile_px = 64, .max_level = 4};
constexpr const char* kEvening = "2026-03-20T18:30Z";  // the terminator lies across Europe
// A level for the rounding of a blend.
constexpr int kOneRounding = 1;
constexpr int kTwoRoundings = 2;    // one for the base layer, one for the layer over it
constexpr int kThreeRoundings = 3;  // one more for a translucent surface's blends
// Half a degree: the Sun's own width, five times the error that the terminator is allowed.
constexpr double kBeside_deg = 0.5;
// Allowed error of the twilight: the larger of these two. The Sun of the test is good to 0.02 degrees, a level of 255
// is 0.02 degrees, and the globe's mesh lies 0.2 pixels off.
constexpr double kTwilight_deg = 0.1, kTwilight_px = 0.5;
constexpr double kDegree = std::numbers::pi / 180.0;

/// Sun's declination and the longitude that it stands over: the Astronomical Almanac's formulas of low precision (page
/// C5: "Low precision formulas for the Sun", 0.01° from 1950 to 2050), and nothing of the engine's.
struct SunOverhead {
  double lat_rad, lon_rad;
};
SunOverhead sun_overhead(double days_since_j2000) {
  const double n = days_since_j2000;
  const double mean_longitude = 280.460 + 0.9856474 * n, anomaly = (357.528 + 0.9856003 * n) * kDegree;
  const double longitude = (mean_longitude + 1.915 * std::sin(anomaly) + 0.020 * std::sin(2.0 * anomaly)) * kDegree;
  const double obliquity = (23.439 - 0.0000004 * n) * kDegree;
  const double right_ascension = std::atan2(std::cos(obliquity) * std::sin(longitude), std::cos(longitude));
  const double greenwich = (280.46062 + 360.98564737 * n) * kDegree;
  return {std::asin(std::sin(obliquity) * std::sin(longitude)), right_ascension - greenwich};
}
// 2026-03-20T18:30Z is 9575.270833… days after 2000-01-01T12:00Z.
const SunOverhead kEveningSun = sun_overhead(9575.0 + 6.5 / 24.0);

double sun_sine(const Geodetic& place, const SunOverhead& sun) {
  const double lat = place.lat.rad();
  return std::sin(lat) * std::sin(sun.lat_rad) +
         std::cos(lat) * std::cos(sun.lat_rad) * std::cos(place.lon.rad() - sun.lon_rad);
}
double sun_height_deg(const Geodetic& place) { return std::asin(sun_sine(place, kEveningSun)) / kDegree; }

std::uint8_t swell(double deg, double middle) {
  return static_cast<std::uint8_t>(std::lround(middle + 50.0 * std::sin(3.0 * deg * kDegree)));
}
Rgba sea(double lon, double row) { return {swell(lon, 60), swell(row, 90), swell(lon, 180), 255}; }
Rgba lamps(double lon, double row) { return {swell(row, 200), swell(lon, 150), swell(row, 60), 255}; }

/// Over Europe from orbit, near a pole, tilted, and so near that a texel is many pixels: by day, at dusk, by night.
std::vector<Camera> dusk_cameras() {
  return {camera_at(45, 0, 9.0e6),  camera_at(88, 30, 4.0e6),   camera_at(30, -9, 2.0e6, 70, -50),
          camera_at(20, -8, 5.0e4), camera_at(20, -2.5, 5.0e4), camera_at(20, 3, 5.0e4)};
}

class DaylightLayers : public GlTest {
 protected:
  static std::shared_ptr<TileSource> painted(LayerSource::Paint paint) {
    return std::make_shared<LayerSource>(kSidesGrid, std::move(paint));
  }
  static GlobeOptions evening() {
    GlobeOptions options;
    options.time = *parse_utc(kEvening);
    return options;
  }
  std::unique_ptr<Globe> empty_globe(const GlobeOptions& options) {
    auto globe = Globe::create(options);
    EXPECT_TRUE(globe);
    return globe ? std::move(*globe) : nullptr;
  }
  Picture settled(Globe& globe) {
    settle(globe, kSides);
    return picture();
  }
  Picture with_look(Globe& globe, LayerId layer, const ImageLook& look) {
    EXPECT_TRUE(globe.set_look(layer, look));
    return settled(globe);
  }
  /// For one of four pixels well within the globe: where it is, by `visit(x, y, place)`.
  static int for_ground(const Globe& globe, const std::function<void(int, int, const Geodetic&)>& visit) {
    int count = 0;
    for (int y = 2; y < kSides.height_px - 2; y += 2) {
      for (int x = 2; x < kSides.width_px - 2; x += 2) {
        bool inside = true;
        for (const glm::dvec2 off : {glm::dvec2(-2, 0), glm::dvec2(2, 0), glm::dvec2(0, -2), glm::dvec2(0, 2)}) {
          inside = inside && globe.pick(glm::dvec2(x + 0.5, y + 0.5) + off, kSides).place;
        }
        const auto place = globe.pick({x + 0.5, y + 0.5}, kSides).place;
        if (!inside || !place) continue;
        visit(x, y, *place);
        ++count;
      }
    }
    return count;
  }
  static int apart(const Picture& a, const Picture& b, int x, int y) {
    const Color p = a.at(x, y), q = b.at(x, y);
    return std::max({std::abs(p[0] - q[0]), std::abs(p[1] - q[1]), std::abs(p[2] - q[2])});
  }
  static int largest_difference(const Picture& a, const Picture& b) {
    int largest = 0;
    for (int y = 0; y < kSides.height_px; ++y) {
      for (int x = 0; x < kSides.width_px; ++x) largest = std::max(largest, apart(a, b, x, y));
    }
    return largest;
  }
  /// The picture is `day` where the Sun is up and `night` from the end of civil twilight on.
  static int expect_sides(const Globe& globe, const Picture& got, const Picture& day, const Picture& night) {
    int judged = 0;
    for_ground(globe, [&](int x, int y, const Geodetic& place) {
      const double height_deg = sun_height_deg(place);
      if (height_deg > kBeside_deg) {
        ++judged;
        EXPECT_LE(apart(got, day, x, y), kTwoRoundings) << x << ' ' << y << ": " << height_deg;
      } else if (height_deg < -6.0 - kBeside_deg) {
        ++judged;
        EXPECT_LE(apart(got, night, x, y), kTwoRoundings) << x << ' ' << y << ": " << height_deg;
      }
    });
    return judged;
  }
};

TEST_F(DaylightLayers, ByDayAPlainLayerByNightNothingAndTheOtherWayRoundByItsOwnLight) {
  std::vector<GlobeOptions> all(5, evening());
  all[1].texturing = Texturing::exact;
  all[2].texturing = Texturing::vertex;
  all[3].texturing = Texturing::paper;
  all[4].sky = true;
  all[4].night_lights = {64, 32, std::vector<std::uint8_t>(64 * 32, 200)};
  for (const GlobeOptions& options : all) {
    const auto globe = empty_globe(options);
    ASSERT_TRUE(globe->add_imagery(painted(sea)));
    const LayerId layer = *globe->add_imagery(painted(lamps));
    int judged = 0;
    for (const Camera& camera : dusk_cameras()) {
      globe->set_camera(camera);
      const Picture plain = with_look(*globe, layer, {});
      globe->set_unlit(true);
      const Picture own_light = settled(*globe);
      globe->set_unlit(false);
      const Picture bare = with_look(*globe, layer, {.shown = false});
      judged += expect_sides(*globe, with_look(*globe, layer, {.daylight = Daylight::day}), plain, bare);
      if (options.sky) continue;  // air lies before the lamps, which dims their own light
      judged += expect_sides(*globe, with_look(*globe, layer, {.daylight = Daylight::night}), bare, own_light);
    }
    EXPECT_GT(judged, options.sky ? 6000 : 12000);
  }
}

TEST_F(DaylightLayers, LightsSwitchedOnLaterAreThoseOfAGlobeMadeWithATime) {
  GlobeOptions timed = evening();
  timed.sky = true;
  timed.night_lights = {64, 32, std::vector<std::uint8_t>(64 * 32, 200)};
  GlobeOptions timeless = timed;
  timeless.time.reset();
  const auto made = empty_globe(timed), changed = empty_globe(timeless);
  EXPECT_TRUE(made->has_night_lights());
  EXPECT_FALSE(changed->has_night_lights());
  for (const auto* globe : {&made, &changed}) {
    ASSERT_TRUE((*globe)->add_imagery(painted(sea)));
    (*globe)->set_camera(camera_at(30, -9, 4.0e6));
  }
  const Picture with_lights = settled(*made);
  ASSERT_TRUE(changed->set_time(timed.time));
  const Picture dark = settled(*changed);
  EXPECT_GT(largest_difference(dark, with_lights), 50);
  for (int twice = 0; twice < 2; ++twice) {
    ASSERT_TRUE(changed->set_night_lights(true));
    EXPECT_EQ(largest_difference(settled(*changed), with_lights), 0);
    ASSERT_TRUE(changed->set_night_lights(false));
    EXPECT_EQ(largest_difference(settled(*changed), dark), 0);
  }
}

TEST_F(DaylightLayers, TheTwilightIsWhereTheAlmanacsFormulasHaveIt) {
  const auto globe = empty_globe(evening());
  ASSERT_TRUE(globe->add_imagery(painted([](double, double) { return Rgba{0, 0, 0, 255}; })));
  ASSERT_TRUE(globe->add_imagery(painted([](double, double) {
                                   return Rgba{255, 255, 255, 255};
                                 }),
                                 {.daylight = Daylight::night}));
  int dusk = 0;
  for (const Camera& camera : dusk_cameras()) {
    globe->set_camera(camera);
    const Picture shown = settled(*globe);
    for_ground(*globe, [&](int x, int y, const Geodetic& place) {
      double least_deg = sun_height_deg(place) - kTwilight_deg, most_deg = least_deg + 2.0 * kTwilight_deg;
      for (const glm::dvec2 off : {glm::dvec2(-kTwilight_px, 0), glm::dvec2(kTwilight_px, 0),
                                   glm::dvec2(0, -kTwilight_px), glm::dvec2(0, kTwilight_px)}) {
        const double beside_deg = sun_height_deg(*globe->pick(glm::dvec2(x + 0.5, y + 0.5) + off, kSides).place);
        least_deg = std::min(least_deg, beside_deg);
        most_deg = std::max(most_deg, beside_deg);
      }
      const auto level = [](double deg) {
        const double t = std::clamp(std::sin(deg * kDegree) / std::sin(6.0 * kDegree) + 1.0, 0.0, 1.0);
        return 255.0 * (1.0 - t * t * (3.0 - 2.0 * t));
      };
      EXPECT_LE(shown.at(x, y)[0], level(least_deg) + kOneRounding) << x << ' ' << y;
      EXPECT_GE(shown.at(x, y)[0], level(most_deg) - kOneRounding) << x << ' ' << y;
      dusk += shown.at(x, y)[0] > 0 && shown.at(x, y)[0] < 255 ? 1 : 0;
    });
  }
  EXPECT_GT(dusk, 2500);
}

// City lights, and a layer of lamps on a globe without city lights. The ground is measured without lamps, lamps on
// black ground.
TEST_F(DaylightLayers, LampsAreLitWhereTheGroundIsDarkAndOutUnderTheSun) {
  const auto all = [](std::uint8_t grey) {
    return painted([grey](double, double) { return Rgba{grey, grey, grey, 255}; });
  };
  for (const bool cities : {true, false}) {
    GlobeOptions options = evening();
    if (cities) {
      options.sky = true;  // city lights need one, though not shown
      options.night_lights = {64, 32, std::vector<std::uint8_t>(64 * 32, 0)};
    }
    const auto ground = empty_globe(options);
    if (cities) options.night_lights = {64, 32, std::vector<std::uint8_t>(64 * 32, 255)};
    const auto lamps = empty_globe(options);
    ASSERT_TRUE(ground->add_imagery(all(255)) && lamps->add_imagery(all(0)));
    if (cities) {
      ground->set_sky(false);
      lamps->set_sky(false);
    } else {
      ASSERT_TRUE(lamps->add_imagery(all(255), {.daylight = Daylight::night}));
    }
    const int dark = cities ? 15 : 64;  // red of white ground by night
    int judged = 0;
    for (const Camera& camera : dusk_cameras()) {
      ground->set_camera(camera);
      lamps->set_camera(camera);
      const Picture day = settled(*ground), night = settled(*lamps);
      for_ground(*ground, [&](int x, int y, const Geodetic& place) {
        const double height_deg = sun_height_deg(place);
        const int light = day.at(x, y)[0], lamp = night.at(x, y)[0];
        SCOPED_TRACE(testing::Message() << height_deg << " degrees: " << light << ' ' << lamp);
        if (height_deg < -6.0 - kBeside_deg) {
          ++judged;
          EXPECT_GE(lamp, 255 - kOneRounding);
          EXPECT_LE(light, dark + kOneRounding);
        } else if (height_deg > kBeside_deg) {
          ++judged;
          EXPECT_EQ(lamp, 0);
          EXPECT_GT(light, dark + 20);
        } else {  // in the twilight one gives way to the other
          EXPECT_TRUE(lamp < 255 || light <= dark + kOneRounding);
          EXPECT_LT(light, 128);
        }
        EXPECT_TRUE(height_deg < 18.0 || light == 255);
      });
    }
    EXPECT_GT(judged, 5000);
  }
}

TEST_F(DaylightLayers, WhatShinesByItselfKeepsItsColourInTheDusk) {
  GlobeOptions options = evening();
  options.sky = true;
  const auto black = [](double, double) { return Rgba{0, 0, 0, 255}; };
  const auto white = [](double, double) { return Rgba{255, 255, 255, 255}; };
  const auto lamps = empty_globe(options);
  ASSERT_TRUE(lamps->add_imagery(painted(black)));
  ASSERT_TRUE(lamps->add_imagery(painted(white), {.daylight = Daylight::night}));
  options.night_lights = {64, 32, std::vector<std::uint8_t>(64 * 32, 255)};
  const auto cities = empty_globe(options);
  ASSERT_TRUE(cities->add_imagery(painted(black)));
  // Colour of city lights, as it is stored (shaders/surface/patch_common.glsl).
  for (const auto& lit : {std::pair{lamps.get(), glm::dvec3(1.0)}, {cities.get(), {1.0, 0.84, 0.54}}}) {
    Globe* const globe = lit.first;
    const glm::dvec3 colour = lit.second;
    int judged = 0;
    // From near and from far: the air has a program of its own near the ground. The Sun is 5 to 1 degrees down.
    for (const double height_m : {2.0e4, 3.0e5}) {
      for (const double lon_deg : {-3.5, -2.0, -0.5}) {
        globe->set_camera(camera_at(30, lon_deg, height_m));
        const Picture seen = settled(*globe);
        for_ground(*globe, [&](int x, int y, const Geodetic&) {
          const Color got = seen.at(x, y);
          if (got[0] < 60) return;
          ++judged;
          // The air between adds the light of dusk and takes 3 % of a colour. Red sunlight took a fifth of green.
          EXPECT_NEAR(got[1], colour.y * got[0], 6.0) << x << ' ' << y;
          EXPECT_NEAR(got[2], colour.z * got[0], 12.0) << x << ' ' << y;
        });
      }
    }
    EXPECT_GT(judged, 2000);
  }
}

// Each patch is drawn with city lights or without, by its place under the Sun.
TEST_F(DaylightLayers, CityLightsFadeInWithTheSunInEachPatch) {
  GlobeOptions options = evening();
  options.sky = true;
  options.night_lights = {64, 32, std::vector<std::uint8_t>(64 * 32, 255)};
  const auto globe = empty_globe(options);
  globe->set_sky(false);  // no air before the lights
  ASSERT_TRUE(globe->add_imagery(painted([](double, double) { return Rgba{0, 0, 0, 255}; })));
  std::vector<Camera> cameras = dusk_cameras();
  for (const double lon_deg : {-60.0, -20.0, 20.0}) cameras.push_back(camera_at(10, lon_deg, 2.0e7));
  int dusk = 0;
  for (const Camera& camera : cameras) {
    globe->set_camera(camera);
    const Picture shown = settled(*globe);
    for_ground(*globe, [&](int x, int y, const Geodetic& place) {
      // Lights begin with civil twilight, and are full at its end.
      const double t = std::clamp(sun_sine(place, kEveningSun) / std::sin(6.0 * kDegree) + 1.0, 0.0, 1.0);
      const double level = 255.0 * (1.0 - t * t * (3.0 - 2.0 * t));
      // Half a pixel of the farthest view is half a degree of the Sun: 32 levels where lights fade fastest.
      EXPECT_NEAR(shown.at(x, y)[0], level, 0.5 + (t > 0.0 && t < 1.0 ? 32.0 : 1.0)) << x << ' ' << y;
      dusk += t > 0.0 && t < 1.0 ? 1 : 0;
    });
  }
  EXPECT_GT(dusk, 2500);
}

TEST_F(DaylightLayers, OpacityAndATranslucentSurfaceGoWithThem) {
  const auto globe = empty_globe(evening());
  globe->set_camera(camera_at(45, 0, 9.0e6));
  ASSERT_TRUE(globe->add_imagery(painted(sea)));
  const LayerId layer = *globe->add_imagery(painted(lamps), {.daylight = Daylight::night});
  ASSERT_TRUE(globe->add_objects({.points = {{.place = {.lat = Angle::degrees(45.0), .lon = {}, .height_m = -9.0e5},
                                              .radius_m = 5.0e5,
                                              .color = {220, 90, 30}}}}));
  const Picture all = settled(*globe), none = with_look(*globe, layer, {.shown = false});
  const Picture half = with_look(*globe, layer, {.opacity = 0.5, .daylight = Daylight::night});
  ASSERT_TRUE(globe->set_look(layer, {.daylight = Daylight::night}));
  globe->set_surface({.alpha = 0.6});
  const Picture translucent = settled(*globe);
  globe->set_surface({.alpha = 0.0});
  const Picture below = settled(*globe);
  for_ground(*globe, [&](int x, int y, const Geodetic&) {
    for (std::size_t c = 0; c < 3; ++c) {
      const auto level = [&](const Picture& p) { return double(p.at(x, y)[c]); };
      EXPECT_NEAR(level(half), 0.5 * (level(all) + level(none)), kOneRounding + 0.5);
      EXPECT_NEAR(level(translucent), 0.6 * level(all) + 0.4 * level(below), kThreeRoundings);
    }
  });
}

TEST_F(DaylightLayers, WithoutATimeOrLightItIsDayEverywhere) {
  for (const bool timed : {false, true}) {
    GlobeOptions options = timed ? evening() : GlobeOptions{};
    options.unlit = timed;
    const auto globe = empty_globe(options);
    globe->set_camera(camera_at(45, 0, 9.0e6));
    ASSERT_TRUE(globe->add_imagery(painted(sea)));
    const LayerId layer = *globe->add_imagery(painted(lamps));
    const Picture plain = settled(*globe);
    EXPECT_EQ(with_look(*globe, layer, {.daylight = Daylight::day}).rgba, plain.rgba);
    const Picture night = with_look(*globe, layer, {.daylight = Daylight::night});
    EXPECT_EQ(with_look(*globe, layer, {.shown = false}).rgba, night.rgba);
  }
}

TEST_F(DaylightLayers, OnTheOtherSideNothingIsReadPickedOrOwed) {
  const auto globe = empty_globe(evening());
  const LayerId below = *globe->add_imagery(painted(sea));
  const LayerId layer = *globe->add_imagery(painted(lamps), {.daylight = Daylight::night});
  ASSERT_TRUE(globe->set_attribution(layer, "lamps"));
  const auto look_at = [&](double lon_deg) {
    globe->set_camera(camera_at(0, lon_deg, 4.0e5));
    const FrameStats stats = settle(*globe, kSides);
    return std::pair(globe->pick({48, 48}, kSides).imagery, stats.tiles_wanted);
  };
  const auto [by_day, day_tiles] = look_at(-90.0);
  EXPECT_EQ(by_day, below);
  EXPECT_TRUE(globe->attributions().empty());
  const auto [by_night, night_tiles] = look_at(90.0);
  EXPECT_EQ(by_night, layer);
  EXPECT_EQ(globe->attributions(), std::vector<std::string>{"lamps"});
  EXPECT_EQ(night_tiles, 2 * day_tiles);
}

TEST_F(DaylightLayers, CloudsAreAsOpaqueAsTheyAreBright) {
  const auto globe = empty_globe(unlit_options());
  ASSERT_TRUE(globe->add_imagery(painted(sea)));
  const auto grey = [](double lon, double) { return Rgba{swell(lon, 120), swell(lon, 120), swell(lon, 120), 255}; };
  const LayerId clouds = *globe->add_imagery(painted(grey));
  for (const Camera& camera : dusk_cameras()) {
    globe->set_camera(camera);
    const Picture own = with_look(*globe, clouds, {}), bare = with_look(*globe, clouds, {.shown = false});
    for (const double opacity : {1.0, 0.7}) {
      const Picture over = with_look(*globe, clouds, {.opacity = opacity, .alpha = AlphaFrom::brightness});
      for_ground(*globe, [&](int x, int y, const Geodetic&) {
        const double grey_level = own.at(x, y)[0];
        for (std::size_t c = 0; c < 3; ++c) {
          const double under = bare.at(x, y)[c] * (1.0 - opacity * grey_level / 255.0);
          EXPECT_NEAR(over.at(x, y)[c], opacity * grey_level + under, kOneRounding + 0.5) << x << ' ' << y;
        }
      });
    }
  }
}

TEST_F(DaylightLayers, AlphaOfTilesGoesWithBrightness) {
  const auto globe = empty_globe(unlit_options());
  globe->set_camera(camera_at(0, 0, 1.0e6));
  ASSERT_TRUE(globe->add_imagery(painted([](double, double) { return Rgba{100, 100, 100, 255}; })));
  ASSERT_TRUE(globe->add_imagery(painted([](double, double) {
                                   return Rgba{200, 100, 0, 128};
                                 }),
                                 {.alpha = AlphaFrom::brightness}));
  const Color got = settled(*globe).at(48, 48);
  constexpr double kTiles = 128.0 / 255.0, kAlpha = kTiles * 200.0 / 255.0;
  EXPECT_NEAR(got[0], kTiles * 200.0 + (1.0 - kAlpha) * 100.0, kOneRounding + 0.5);
  EXPECT_NEAR(got[1], kTiles * 100.0 + (1.0 - kAlpha) * 100.0, kOneRounding + 0.5);
  EXPECT_NEAR(got[2], (1.0 - kAlpha) * 100.0, kOneRounding + 0.5);
}

TEST_F(DaylightLayers, LieOnReliefInTheLightOfTheLevelGround) {
  const auto heights = ElevationSource::open(
      painted_heights({.tile_px = 64, .max_level = 2},
                      [](double lat, double lon) { return 3000.0 * std::sin(40.0 * lat) * std::cos(40.0 * lon); }),
      "heights");
  ASSERT_TRUE(heights);
  const auto globe = empty_globe(evening());
  ASSERT_TRUE(globe->set_elevation(*heights));
  globe->set_camera(camera_at(30, -5, 2.0e6));
  ASSERT_TRUE(globe->add_imagery(painted(sea)));
  const LayerId layer = *globe->add_imagery(painted(lamps));
  const Picture plain = with_look(*globe, layer, {});
  globe->set_unlit(true);
  const Picture own_light = settled(*globe);
  globe->set_unlit(false);
  const Picture bare = with_look(*globe, layer, {.shown = false});
  EXPECT_GT(expect_sides(*globe, with_look(*globe, layer, {.daylight = Daylight::day}), plain, bare), 250);
  EXPECT_GT(expect_sides(*globe, with_look(*globe, layer, {.daylight = Daylight::night}), bare, own_light), 250);
}

}  // namespace
}  // namespace terrella::test
