// The views that break globes, with mountains, a translucent surface and two eyes at once.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <optional>

#include "tests/gl/eye_sights.h"
#include "tests/gl/mountains.h"
#include "tests/scene/patch_test_support.h"

namespace terrella::test {
namespace {

const TileGrid kHardGrid{.tile_px = 64, .max_level = 1};
constexpr double kExaggeration = 20.0;
constexpr double kTop_m = kExaggeration * kMost_m;
constexpr Color kNearSide = {90, 200, 140}, kFarSide = {250, 20, 20};
// An eye 10^8 m away, or over a mountain, sees no further round the planet than this.
constexpr double kFarSide_deg = 105.0;

/// Green where an eye over a place may see the ground, red on the other side.
std::shared_ptr<TileSource> two_sided(const Geodetic& eye) {
  const glm::dvec3 over = Ellipsoid::normal(eye.lat, eye.lon).xyz;
  return std::make_shared<PaintedSource>(kHardGrid, [over](double lon_deg, double row_deg) {
    const glm::dvec3 n = Ellipsoid::normal(Angle::degrees(row_deg), Angle::degrees(lon_deg)).xyz;
    return glm::dot(n, over) < std::cos(kFarSide_deg * std::numbers::pi / 180.0) ? kFarSide : kNearSide;
  });
}

class ReliefHardCases : public GlTest {
 protected:
  static GlobeOptions hard_options(Stereo stereo, const Body& body) {
    GlobeOptions options = unlit_options();
    options.body = body;
    options.exaggeration = kExaggeration;
    options.surface.alpha = 0.5;
    options.stereo.mode = stereo;
    return options;
  }

  /// No background where every line of sight meets the lowest ground there can be, and no red anywhere.
  void judge(const Globe& globe, Viewport size, const std::string& words) {
    const Ellipsoid& body = globe.options().body.ellipsoid;
    const Ellipsoid lowest(body.a_m() - 1.02 * kTop_m, body.f());
    const Picture seen = picture();
    const int step = size.width_px > 1000 ? 97 : 1;  // a wide picture is looked at here and there
    int holes = 0, far_side = 0;
    for (const EyeSight& eye : eye_sights(globe, seen)) {
      for (int y = 0; y < eye.view.viewport.height_px; ++y) {
        for (int x = 0; eye.has_row(y) && x < eye.view.viewport.width_px; x += step) {
          if (!lowest.intersect_m(eye.view.eye, pixel_ray(eye.view, glm::dvec2(x + 0.5, y + 0.5)))) continue;
          const Color color = eye.at({x, y});
          bool lit = false;
          for (std::size_t k = 0; k < 3; ++k) lit = lit || (eye.channels[k] && color[k] > kNearSide[k] / 3);
          holes += lit ? 0 : 1;
          far_side += eye.channels[0] && color[0] > kNearSide[0] ? 1 : 0;
        }
      }
    }
    EXPECT_EQ(holes, 0) << words;
    EXPECT_EQ(far_side, 0) << words;
  }

  void check_from_above(Stereo stereo, const Body& body, const std::vector<Camera>& cameras, Viewport size) {
    // The two colours are for one place of the eye: another place has its own far side.
    const auto globe = mountainous_globe(hard_options(stereo, body), two_sided(cameras.front().eye));
    for (const Camera& asked : cameras) {
      Camera camera = asked;
      globe->set_camera(camera);
      settle(*globe, size);
      camera.eye.height_m += globe->ground_height_m(camera.eye.lat, camera.eye.lon);
      globe->set_camera(camera);
      settle(*globe, size);
      judge(*globe, size,
            "stereo " + std::to_string(static_cast<int>(stereo)) + " body " + body.name + " eye " +
                std::to_string(camera.eye.lat.deg()) + "," + std::to_string(camera.eye.lon.deg()) + "," +
                std::to_string(camera.eye.height_m) + " pitch " + std::to_string(camera.pitch.deg()));
    }
  }
};

constexpr Viewport kPair{64, 32};
constexpr std::array kStereos = {Stereo::side_by_side, Stereo::interlaced, Stereo::anaglyph};

/// Over one place, heights over the ground: street and Moon in one run, the horizon grazed, straight down and up.
std::vector<Camera> from_street_to_moon(double lat, double lon) {
  return {camera_at(lat, lon, 1.0, 30, -20), camera_at(lat, lon, 1.0e8, 0, -90, 10), camera_at(lat, lon, 1.0, 0, 90),
          camera_at(lat, lon, 2000.0, 200, -1), camera_at(lat, lon, 3.0e5, 80, -12, 60)};
}

TEST_F(ReliefHardCases, FromAMetreToAHundredThousandKilometresNothingIsMissingAndNoFarSideShows) {
  for (const Stereo stereo : kStereos) check_from_above(stereo, earth(), from_street_to_moon(12.0, 25.0), kPair);
}

TEST_F(ReliefHardCases, OverAPoleAndOnTheAntimeridian) {
  for (const Stereo stereo : kStereos) {
    check_from_above(stereo, earth(), from_street_to_moon(90.0, 0.0), kPair);
    check_from_above(stereo, earth(), from_street_to_moon(-3.0, 180.0), kPair);
  }
}

TEST_F(ReliefHardCases, OnTheFlattestPlanet) {
  const Body flat = *parse_body("6378137,0.098");
  for (const Stereo stereo : kStereos) check_from_above(stereo, flat, from_street_to_moon(50.0, -20.0), kPair);
}

TEST_F(ReliefHardCases, InTheSmallestAndTheWidestPicture) {
  for (const Viewport size : {Viewport{1, 1}, Viewport{16384, 16}}) {
    check_from_above(Stereo::side_by_side, earth(), {camera_at(12, 25, 2000.0, 30, -40, 20), camera_at(12, 25, 4.0e6)},
                     size);
  }
}

TEST_F(ReliefHardCases, UnderTheGroundAndAtThePlanetsCentreTheGroundIsAllAround) {
  for (const Stereo stereo : kStereos) {
    GlobeOptions options = hard_options(stereo, earth());
    options.surface.from_below = SurfaceFromBelow::translucent;
    options.surface.inner_sphere_below_m.reset();
    const auto globe = mountainous_globe(options, one_colour(kHardGrid, kNearSide));
    for (const double height_m : {-5.0, -5000.0, -2.0e6, -6.378137e6}) {
      for (const double pitch : {-90.0, -10.0, 35.0, 90.0}) {
        Camera camera = camera_at(12, 25, height_m, 70, pitch, 70);
        globe->set_camera(camera);
        settle(*globe, kPair);
        // Near the ground, so far under where it is drawn; deep down, so far under the ellipsoid.
        if (height_m > -1.0e6) {
          camera.eye.height_m += globe->ground_height_m(camera.eye.lat, camera.eye.lon);
          globe->set_camera(camera);
          settle(*globe, kPair);
        }
        const Picture seen = picture();
        int holes = 0;
        for (int k = 0; k < kPair.width_px * kPair.height_px; ++k) {
          holes += seen.at(k % kPair.width_px, k / kPair.width_px)[1] < kNearSide[1] / 3 ? 1 : 0;
        }
        EXPECT_EQ(holes, 0) << "stereo " << static_cast<int>(stereo) << " height " << height_m << " pitch " << pitch;
      }
    }
  }
}

/// A square of 3° at a height, the larger one over the smaller.
PolygonObject sheet(double height_m, const ObjectColor& color) {
  const auto corner = [height_m](double lat, double lon) {
    return Geodetic{.lat = Angle::degrees(lat), .lon = Angle::degrees(lon), .height_m = height_m};
  };
  return {.rings = {{corner(-1.5, -1.5), corner(-1.5, 1.5), corner(1.5, 1.5), corner(1.5, -1.5)}},
          .fill = color,
          .stroke = {0, 0, 0, 0}};
}

TEST_F(ReliefHardCases, TwoSurfacesAMetreApartSeenFromAThousandKilometresDoNotFlicker) {
  constexpr ObjectColor kLower{250, 0, 0}, kUpper{0, 0, 250};
  constexpr Viewport kSheetPicture{64, 64};
  constexpr double kOverMountains_m = 1.05 * kTop_m;
  GlobeOptions options = unlit_options();
  options.exaggeration = kExaggeration;
  const auto globe = mountainous_globe(options, one_colour(kHardGrid, kNearSide));
  const auto sheets = globe->add_objects({});
  ASSERT_TRUE(sheets);
  for (const bool upper_first : {false, true}) {
    const PolygonObject lower = sheet(kOverMountains_m, kLower), upper = sheet(kOverMountains_m + 1.0, kUpper);
    ObjectScene scene;
    scene.polygons = upper_first ? std::vector{upper, lower} : std::vector{lower, upper};
    ASSERT_TRUE(globe->set_objects(*sheets, scene));
    Draw draw(7);
    for (int k = 0; k < 40; ++k) {
      // The sheets fill the picture: 2° of 40° of view from 1000 km over them; jittered by metres and seconds of arc.
      Camera camera =
          camera_at(draw.between(-1e-4, 1e-4), draw.between(-1e-4, 1e-4),
                    kOverMountains_m + 1.0e6 + draw.between(-10.0, 10.0), draw.between(0.0, 360.0), -90, 12);
      globe->set_camera(camera);
      settle(*globe, kSheetPicture);
      const Picture seen = picture();
      int wrong = 0;
      for (int p = 0; p < 64 * 64; ++p) wrong += seen.at(p % 64, p / 64) != Color{0, 0, 250} ? 1 : 0;
      ASSERT_EQ(wrong, 0) << "camera " << k << (upper_first ? ", upper one first" : ", lower one first");
    }
  }
}

TEST_F(ReliefHardCases, StarsChangeNothingOfWhatStandsBeforeThem) {
  constexpr Viewport kSize{128, 128};
  // Air lies before all, in both pictures; stars lie behind all.
  const auto draw = [&](bool sky, bool stars, const Camera& camera) {
    GlobeOptions options;
    options.exaggeration = kExaggeration;
    options.sky = sky;
    for (int k = 0; stars && k < 2000; ++k) {
      const double z = 1.0 - 2.0 * (k + 0.5) / 2000.0, turn = 2.4 * k, r = std::sqrt(1.0 - z * z);
      options.stars.push_back({.direction_j2000 = {r * std::cos(turn), r * std::sin(turn), z},
                               .magnitude = 1.0F,
                               .color_linear = {1.0F, 1.0F, 1.0F}});
    }
    const auto globe = mountainous_globe(options, one_colour(kHardGrid, kNearSide));
    ObjectScene scene;
    const double top_m = kTop_m;
    // Before, in and behind the mountains.
    for (const double lon : {25.5, 26.5, 28.0, 31.0}) {
      scene.points.push_back(
          {.place = {.lat = Angle::degrees(12.0), .lon = Angle::degrees(lon), .height_m = 0.9 * top_m},
           .radius_m = 4.0e4,
           .color = {250, 30, 30}});
    }
    EXPECT_TRUE(globe->add_objects(scene));
    globe->set_camera(camera);
    settle(*globe, kSize);
    return picture();
  };
  for (const Camera& camera : {camera_at(12, 25, 1.2 * kTop_m, 90, -8, 60), camera_at(12, 25, 2.0e6, 90, -50, 60)}) {
    const Picture bare = draw(false, false, camera), without = draw(true, false, camera),
                  with = draw(true, true, camera);
    int before_sky = 0, changed = 0, sky = 0;
    for (int y = 1; y + 1 < kSize.height_px; ++y) {
      for (int x = 1; x + 1 < kSize.width_px; ++x) {
        const Color a = without.at(x, y), b = with.at(x, y);
        const bool something = bare.at(x, y) != Color{0, 0, 0};
        // The soft edge of a sphere takes a part of what lies behind it.
        bool inside = something;
        for (int n = 0; n < 9; ++n) inside = inside && bare.at(x + n % 3 - 1, y + n / 3 - 1) != Color{0, 0, 0};
        before_sky += inside ? 1 : 0;
        changed += inside && a != b ? 1 : 0;
        sky += !something && a != b ? 1 : 0;
      }
    }
    EXPECT_GT(before_sky, 3000);
    EXPECT_GT(sky, 100) << "no stars in the picture: nothing was tested";
    EXPECT_EQ(changed, 0);
  }
}

}  // namespace
}  // namespace terrella::test
