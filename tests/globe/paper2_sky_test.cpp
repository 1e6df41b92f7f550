// Paper 2: neither stars nor Sun, Moon or air show through the globe, whatever its alpha, and none of them moves a
// depth.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <numbers>

#include "globe/experiments.h"
#include "sky/almanac.h"
#include "tests/gl/eye_sights.h"
#include "tests/scene/patch_test_support.h"
#include "view/stereo.h"

namespace terrella::test {
namespace {

constexpr Color kDarkGround = {200, 120, 40};
constexpr Viewport kSkyPicture{160, 160};
// Bright enough to be seen through anything, and one in every pixel or two of the globe.
constexpr int kStars = 6000;
constexpr float kStarMagnitude = 0.0F;
// A ball looked at from its night side has four fifths of its colour, and half of that by its alpha.
constexpr Color kShadedGlass = {16, 92, 24};
// The air is dithered, by half a level before rounding.
constexpr int kDither_levels = 1;
// The limb takes its colours from both sides; from 20,000 km it is a pixel wide, a hundredth of the radius.
constexpr double kBesideTheLimb = 0.03;

/// Spread evenly over the sky, on a spiral.
std::vector<Star> stars_everywhere() {
  std::vector<Star> stars;
  for (int k = 0; k < kStars; ++k) {
    const double z = 1.0 - 2.0 * (k + 0.5) / kStars, turn = k * std::numbers::pi * (3.0 - std::sqrt(5.0));
    const double r = std::sqrt(1.0 - z * z);
    stars.push_back({glm::vec3(r * std::cos(turn), r * std::sin(turn), z), kStarMagnitude, glm::vec3(1.0F)});
  }
  return stars;
}

std::vector<glm::ivec2> square_around(const EyeSight& eye, glm::ivec2 middle) {
  constexpr int kHalf_px = 5;
  std::vector<glm::ivec2> square;
  for (int y = middle.y - kHalf_px; y <= middle.y + kHalf_px; ++y) {
    for (int x = middle.x - kHalf_px; x <= middle.x + kHalf_px && eye.has_row(y); ++x) square.emplace_back(x, y);
  }
  return square;
}

class Paper2Sky : public GlTest, public testing::WithParamInterface<Stereo> {
 protected:
  /// The Sun stands behind the globe: at that time it is overhead at 23.4°N 0.5°E.
  std::unique_ptr<Globe> night_side(bool naive = false, std::vector<PointObject> objects = {},
                                    std::vector<Star> stars = stars_everywhere()) {
    GlobeOptions options;
    options.sky = true;
    options.time = *parse_utc("2026-06-21T12:00Z");
    options.stars = std::move(stars);
    options.stereo.mode = GetParam();
    auto globe = make_globe(options, one_colour({.tile_px = 64, .max_level = 1}, kDarkGround));
    Experiments::of(*globe).naive_translucency = naive;
    EXPECT_TRUE(globe->add_objects({.points = std::move(objects)}));
    globe->set_camera(camera_at(-23.4, -179.5, 2.0e7));
    settle(*globe, size());
    return globe;
  }
  Picture look(Globe& globe, double alpha, bool sky) {
    globe.set_surface({.alpha = alpha});
    globe.set_sky(sky);
    draw(globe, size());
    return picture();
  }
  [[nodiscard]] static Viewport size() { return picture_size(GetParam(), kSkyPicture); }

  /// Counts the pixels of the globe that its stars change, for each eye. The other globe has air too, and no stars.
  std::vector<int> changed_inside(Globe& globe, Globe& starless, double alpha) {
    const Picture with = look(globe, alpha, true), without = look(starless, alpha, true);
    const std::vector<EyeSight> lit = eye_sights(globe, with), dark = eye_sights(globe, without);
    std::vector<int> changed;
    for (std::size_t k = 0; k < lit.size(); ++k) {
      int count = 0;
      for (const glm::ivec2 px : pixels_inside(lit[k], earth().ellipsoid, kBesideTheLimb)) {
        count += lit[k].sees(lit[k].at(px), dark[k].at(px), 0) ? 0 : 1;
      }
      changed.push_back(count);
    }
    return changed;
  }
};

TEST_P(Paper2Sky, NeverShowsThroughTheGlobe) {
  const auto globe = night_side(), starless = night_side(false, {}, {});
  for (const double alpha : {0.0, 0.25, 0.5, 0.9, 1.0}) {
    for (const int changed : changed_inside(*globe, *starless, alpha)) EXPECT_EQ(changed, 0) << "alpha " << alpha;
  }
}

TEST_P(Paper2Sky, ShowsThroughWhereTransparencyIsJustSwitchedOn) {
  const auto globe = night_side(true), starless = night_side(true, {}, {});
  for (const int changed : changed_inside(*globe, *starless, 0.5)) {
    EXPECT_GT(changed, 500) << "paper 2's figure 2.24 is not reproduced";
  }
}

TEST_P(Paper2Sky, IsThereBesideTheGlobeForEveryEye) {
  const auto globe = night_side();
  const Picture with = look(*globe, 0.5, true), without = look(*globe, 0.5, false);
  const std::vector<EyeSight> lit = eye_sights(*globe, with), dark = eye_sights(*globe, without);
  const Ellipsoid larger(earth().ellipsoid.a_m() * 1.05, earth().ellipsoid.f());
  const Almanac almanac = *almanac_at(*parse_utc("2026-06-21T12:00Z"));
  for (std::size_t k = 0; k < lit.size(); ++k) {
    int stars = 0, found = 0;
    for (const Star& star : stars_everywhere()) {
      const EcefDir ray{almanac.ecef_from_j2000 * glm::dvec3(star.direction_j2000)};
      if (larger.intersect_m(lit[k].view.eye, ray)) continue;
      const auto px = lit[k].pixel_of({lit[k].view.eye.xyz_m + 1.0e9 * ray.xyz});
      if (!px) continue;
      ++stars;
      found += lit[k].sees(lit[k].at(*px), dark[k].at(*px), 12) ? 0 : 1;
    }
    EXPECT_GT(stars, 20) << "no stars beside the globe";
    EXPECT_EQ(found, stars) << lit[k].name << ": stars that are not where the eye sees them";
  }
}

TEST_P(Paper2Sky, IsUnderWhatIsOverTheGroundAndTranslucent) {
  // Over the limb, before the air and the stars: green with half of what is behind it.
  const PointObject glass{.place = {.lat = Angle::degrees(-23.4), .lon = Angle::degrees(105.0), .height_m = 6.0e5},
                          .radius_m = 6.0e5,
                          .color = {40, 230, 60, 128}};
  const auto globe = night_side(false, {glass});
  const Picture with = look(*globe, 0.5, true), without = look(*globe, 0.5, false);
  const std::vector<EyeSight> lit = eye_sights(*globe, with), dark = eye_sights(*globe, without);
  const Ecef place = earth().ellipsoid.to_ecef(glass.place);
  const Ellipsoid beside_limb(earth().ellipsoid.a_m() * (1.0 + kBesideTheLimb), earth().ellipsoid.f());
  for (std::size_t k = 0; k < lit.size(); ++k) {
    const auto px = lit[k].pixel_of(place);
    ASSERT_TRUE(px);
    EXPECT_TRUE(dark[k].sees(dark[k].at(*px), kShadedGlass, 2)) << words_of(dark[k], *px, dark[k].at(*px));
    int brighter = 0;
    for (const glm::ivec2 at : square_around(lit[k], *px)) {
      // The ground behind is darker through the air, and so is the limb.
      if (pick(lit[k].view, beside_limb, glm::dvec2(at) + 0.5)) continue;
      const Color a = lit[k].at(at), b = dark[k].at(at);
      for (std::size_t c = 0; c < 3; ++c) {
        if (!lit[k].channels[c]) continue;
        EXPECT_GE(a[c] + kDither_levels, b[c]) << "the sky was drawn over it";
        brighter += a[c] > b[c] ? 1 : 0;
      }
    }
    EXPECT_GT(brighter, 0) << lit[k].name << ": no sky behind it";
  }
}

TEST_P(Paper2Sky, IsNotSeenFromUnderTheGround) {
  const auto globe = night_side();
  globe->set_camera(camera_at(-23.4, -179.5, -2.0e5, 0, 60));
  for (const SurfaceFromBelow mode : {SurfaceFromBelow::opaque, SurfaceFromBelow::translucent}) {
    std::vector<Picture> seen;
    for (const bool sky : {true, false}) {
      globe->set_surface({.alpha = 0.5, .from_below = mode});
      globe->set_sky(sky);
      settle(*globe, size());
      seen.push_back(picture());
    }
    EXPECT_EQ(seen[0].rgba, seen[1].rgba) << "mode " << static_cast<int>(mode);
  }
}

class Paper2Halves : public GlTest {};

TEST_F(Paper2Halves, AStarAtTheEdgeOfOneStaysInIt) {
  // As bright as Venus and more: a spot many pixels wide, whose middle is the left half's last column.
  constexpr float kWideSpot = -7.0F;
  const UtcTime time = *parse_utc("2026-06-21T12:00Z");
  GlobeOptions options;
  options.sky = true;
  options.time = time;
  options.stereo = {.mode = Stereo::side_by_side, .eye_separation_m = {}};
  const Camera camera = camera_at(-23.4, -179.5, 1.0e8);
  const View view = make_view(camera, earth().ellipsoid, kSkyPicture);
  const glm::dvec2 edge(kSkyPicture.width_px - 0.5, 0.25 * kSkyPicture.height_px);
  const EyePair eyes = stereo_eyes(view, earth().ellipsoid, options.stereo);
  const glm::dvec3 j2000 = glm::transpose(almanac_at(time)->ecef_from_j2000) * pixel_ray(eyes.left, edge).xyz;
  options.stars = {{glm::vec3(j2000), kWideSpot, glm::vec3(1.0F)}};
  const auto globe = make_globe(options, one_colour({.tile_px = 64, .max_level = 1}, kDarkGround));
  globe->set_camera(camera);
  settle(*globe, {2 * kSkyPicture.width_px, kSkyPicture.height_px});
  const Picture seen = picture();
  const int row = kSkyPicture.height_px / 4;
  EXPECT_GT(seen.at(kSkyPicture.width_px - 1, row)[0], 200) << "no star at the edge";
  for (int x = kSkyPicture.width_px; x < kSkyPicture.width_px + 10; ++x) EXPECT_LT(seen.at(x, row)[0], 10) << x;
}

INSTANTIATE_TEST_SUITE_P(ByEye, Paper2Sky, testing::ValuesIn(kAllStereo), &stereo_test_name);

}  // namespace
}  // namespace terrella::test
