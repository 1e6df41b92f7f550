// Ground that rises and sinks, against rays cast through the same heights.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <sstream>

#include "globe/experiments.h"
#include "tests/gl/mountains.h"
#include "tests/scene/patch_test_support.h"

namespace terrella::test {
namespace {

constexpr Color kGround = {220, 190, 140};
constexpr Viewport kReliefPicture{128, 128};
const TileGrid kPictureGrid{.tile_px = 64, .max_level = 1};

class GlobeRelief : public GlTest {
 protected:
  static std::unique_ptr<Globe> mountains(const GlobeOptions& options, double waves = 18.0) {
    return mountainous_globe(options, one_colour(kPictureGrid, kGround), waves);
  }
};

std::string words_of(const Camera& c, double exaggeration) {
  std::ostringstream out;
  out.precision(12);
  out << c.eye.lat.deg() << ',' << c.eye.lon.deg() << ',' << c.eye.height_m << ',' << c.heading.deg() << ','
      << c.pitch.deg() << ',' << c.fov_y.deg() << " exaggeration " << exaggeration;
  return out.str();
}

/// True if a ray meets the ground, by the heights themselves. Steps are short beside the mountains.
bool meets_ground(const View& view, const Ellipsoid& body, glm::dvec2 px, double exaggeration) {
  const EcefDir ray = pixel_ray(view, px);
  const double top_m = exaggeration * kMost_m;
  const Ellipsoid over(body.a_m() + top_m, body.f());
  const auto enters = over.intersect_m(view.eye, ray);
  if (!enters) return false;
  // Twice the way down from the highest to the lowest ground, or through to the other side where it is grazed.
  const double reach_m = 2.2 * std::sqrt(2.0 * body.a_m() * 2.0 * top_m) + 4.0 * top_m;
  constexpr int kSteps =
      600;  // between two steps a ridge 2,000 km long sinks by some metres, and a pixel has kilometres
  for (int k = 0; k <= kSteps; ++k) {
    const Ecef p{view.eye.xyz_m + (*enters + reach_m * k / kSteps) * ray.xyz};
    const Geodetic at = body.to_geodetic(p);
    if (at.height_m < exaggeration * mountain_m(at.lat.rad(), at.lon.rad())) return true;
  }
  return false;
}

TEST_F(GlobeRelief, MountainsStandAgainstTheSkyWhereRaysMeetThem) {
  // Disagreement further than a pixel from where the rays themselves change their mind is an error of over a pixel.
  for (const double exaggeration : {1.0, 5.0, 20.0}) {
    GlobeOptions options = unlit_options();
    options.exaggeration = exaggeration;
    const auto globe = mountains(options);
    const Ellipsoid& body = earth().ellipsoid;
    for (const Camera& camera : {camera_at(10, 20, 4.0e5, 40, -18, 30), camera_at(-30, 179, 9.0e5, 250, -28, 30)}) {
      globe->set_camera(camera);
      settle(*globe, kReliefPicture);
      const View view = globe->view(kReliefPicture);
      std::vector<bool> truth;
      for (int y = 0; y < kReliefPicture.height_px; ++y) {
        for (int x = 0; x < kReliefPicture.width_px; ++x) {
          truth.push_back(meets_ground(view, body, glm::dvec2(x + 0.5, y + 0.5), exaggeration));
        }
      }
      const auto at = [&](int x, int y) { return truth[static_cast<std::size_t>(y * kReliefPicture.width_px + x)]; };
      const Picture seen = picture();
      int wrong = 0, edge = 0;
      for (int y = 1; y + 1 < kReliefPicture.height_px; ++y) {
        for (int x = 1; x + 1 < kReliefPicture.width_px; ++x) {
          bool clear = true;
          for (int k = 0; k < 9; ++k) clear = clear && at(x + k % 3 - 1, y + k / 3 - 1) == at(x, y);
          edge += clear ? 0 : 1;
          wrong += clear && (seen.at(x, y)[0] > 100) != at(x, y) ? 1 : 0;
        }
      }
      EXPECT_GT(edge, 100) << "no sky in the picture: nothing was tested";
      EXPECT_EQ(wrong, 0) << words_of(camera, exaggeration);
    }
  }
}

TEST_F(GlobeRelief, TheirOutlineIsAntialiased) {
  GlobeOptions options = unlit_options();
  options.exaggeration = 5.0;
  const auto globe = mountains(options);
  globe->set_camera(camera_at(10, 20, 4.0e5, 40, -18, 30));
  settle(*globe, kReliefPicture);
  const Picture seen = picture();
  const auto is_ground = [&](int x, int y) { return seen.at(x, y)[0] > kGround[0] - 10; };
  const auto is_sky = [&](int x, int y) { return seen.at(x, y)[0] < 10; };
  int between = 0;
  constexpr int kNear_px = 2;
  for (int y = kNear_px; y + kNear_px < kReliefPicture.height_px; ++y) {
    for (int x = kNear_px; x + kNear_px < kReliefPicture.width_px; ++x) {
      if (is_ground(x, y) || is_sky(x, y)) continue;
      ++between;
      int ground = 0, sky = 0;
      for (int k = 0; k < 25; ++k) {
        ground += is_ground(x + k % 5 - kNear_px, y + k / 5 - kNear_px) ? 1 : 0;
        sky += is_sky(x + k % 5 - kNear_px, y + k / 5 - kNear_px) ? 1 : 0;
      }
      EXPECT_TRUE(ground > 0 && sky > 0) << x << ',' << y << " is on no outline";
    }
  }
  constexpr int kFewest = 20;  // an outline of over a hundred pixels has more; stairs have none
  EXPECT_GT(between, kFewest) << "the outline is stairs";
}

TEST_F(GlobeRelief, HasNoCrackFromAThousandRandomCamerasHoweverExaggerated) {
  constexpr Viewport kTiny{32, 32};
  Draw draw(61);
  int cameras = 0;
  for (const double exaggeration : {1.0, 2.0, 3.5, 5.0, 7.5, 10.0, 12.0, 15.0, 18.0, 20.0}) {
    GlobeOptions options = unlit_options();
    options.exaggeration = exaggeration;
    const auto globe = mountains(options);
    const double top_m = exaggeration * kMost_m;
    const Ellipsoid lowest(earth().ellipsoid.a_m() - top_m, earth().ellipsoid.f());
    for (int k = 0; k < 100 && !HasFailure(); ++k, ++cameras) {
      const Camera camera = random_camera(draw, 1.1 * top_m, 5.0e7);
      globe->set_camera(camera);
      settle(*globe, kTiny);
      const View view = globe->view(kTiny);
      const Picture seen = picture();
      int holes = 0;
      for (int y = 0; y < kTiny.height_px; ++y) {
        for (int x = 0; x < kTiny.width_px; ++x) {
          const EcefDir ray = pixel_ray(view, glm::dvec2(x + 0.5, y + 0.5));
          if (lowest.intersect_m(view.eye, ray) && seen.at(x, y)[0] < 100) ++holes;
        }
      }
      EXPECT_EQ(holes, 0) << words_of(camera, exaggeration);
    }
  }
  EXPECT_EQ(cameras, 1000);
}

/// Waves 20° long in longitude and in latitude, which imagery of 0.7° a texel shows within a level; flat at the poles,
/// where longitude turns within a pixel.
Color painted(double lon_deg, double row_deg) {
  const double turn = 18.0 * std::numbers::pi / 180.0, cosine = std::cos(row_deg * std::numbers::pi / 180.0);
  const auto level = [](double wave) { return static_cast<std::uint8_t>(std::lround(130.0 + 100.0 * wave)); };
  return {level(std::sin(turn * lon_deg) * cosine), level(std::sin(turn * row_deg)),
          level(std::cos(turn * (lon_deg + row_deg)) * cosine)};
}

TEST_F(GlobeRelief, ImageryLiesWhereRaysMeetTheHeights) {
  // A pixel shows what a ray finds within a pixel around it: where the ground is a pixel too high or too low, it does
  // not.
  constexpr Viewport kSize{96, 96};
  constexpr int kLevels = 4;  // levels of colour: 8 bits, and the error of bilinear imagery in its waves
  for (const double exaggeration : {1.0, 8.0, 20.0}) {
    GlobeOptions options = unlit_options();
    options.exaggeration = exaggeration;
    const auto imagery = std::make_shared<PaintedSource>(TileGrid{.tile_px = 128, .max_level = 2}, painted);
    const auto globe = mountainous_globe(options, imagery);
    for (const Camera& camera : {camera_at(10, 20, 8.0e5, 40, -45, 40), camera_at(-30, 179, 6.0e5, 250, -60, 40),
                                 camera_at(89.5, 3, 9.0e5, 10, -75, 40)}) {
      globe->set_camera(camera);
      settle(*globe, kSize);
      const View view = globe->view(kSize);
      std::vector<std::optional<Color>> truth;
      for (int k = 0; k < 96 * 96; ++k) {
        const auto place = pick(view, globe->ground(), {k % 96 + 0.5, k / 96 + 0.5});
        truth.push_back(place ? std::optional(painted(place->lon.deg(), place->lat.deg())) : std::nullopt);
      }
      const Picture seen = picture();
      int judged = 0, wrong = 0;
      for (int y = 1; y < 95; ++y) {
        for (int x = 1; x < 95; ++x) {
          bool whole = true, right = true;
          for (std::size_t channel = 0; channel < 3; ++channel) {
            int least = 255, most = 0;
            for (int n = 0; n < 9; ++n) {
              const auto& t = truth[static_cast<std::size_t>((y + n / 3 - 1) * 96 + x + n % 3 - 1)];
              whole = whole && t.has_value();
              if (!t) continue;
              least = std::min<int>(least, (*t)[channel]);
              most = std::max<int>(most, (*t)[channel]);
            }
            const int level = seen.at(x, y)[channel];
            right = right && level >= least - kLevels && level <= most + kLevels;
          }
          judged += whole ? 1 : 0;
          wrong += whole && !right ? 1 : 0;
        }
      }
      EXPECT_GT(judged, 5000) << words_of(camera, exaggeration);
      EXPECT_EQ(wrong, 0) << words_of(camera, exaggeration);
    }
  }
}

TEST_F(GlobeRelief, TellsTheHeightThatItDraws) {
  GlobeOptions options = unlit_options();
  options.exaggeration = 3.0;
  const auto globe = mountains(options);
  globe->set_camera(camera_at(10, 20, 3.0e5));
  settle(*globe, kReliefPicture);
  const double lat = 10.2 * std::numbers::pi / 180.0, lon = 20.3 * std::numbers::pi / 180.0;
  // Three times what bilinear heights a third of a degree apart miss.
  EXPECT_NEAR(globe->ground_height_m(Angle::radians(lat), Angle::radians(lon)), 3.0 * mountain_m(lat, lon), 3.0 * 8.0);
}

TEST_F(GlobeRelief, ThroughATranslucentMountainNoOtherMountainShows) {
  const auto pixels_drawn_twice = [this](bool naive) {
    GlobeOptions options = unlit_options();
    options.exaggeration = 20.0;
    options.surface.alpha = 0.5;
    const auto globe = mountains(options, 90.0);  // 4° apart: one behind the other before the horizon
    Experiments::of(*globe).naive_translucency = naive;
    globe->set_camera(camera_at(10, 20, 1.2e5, 90, -5, 70));
    settle(*globe, kReliefPicture);
    const Picture seen = picture();
    int twice = 0;
    for (int k = 0; k < kReliefPicture.width_px * kReliefPicture.height_px; ++k) {
      const int red = seen.at(k % kReliefPicture.width_px, k / kReliefPicture.width_px)[0];
      twice += red > kGround[0] / 2 + 1 ? 1 : 0;
    }
    return twice;
  };
  EXPECT_GT(pixels_drawn_twice(true), 100) << "the view has no mountain before a mountain";
  EXPECT_EQ(pixels_drawn_twice(false), 0);
}

}  // namespace
}  // namespace terrella::test
