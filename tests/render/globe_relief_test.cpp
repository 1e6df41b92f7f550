// Ground that rises and sinks, against rays cast through the same heights (issue: the translucent globe).
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <sstream>

#include "gl_fixture.h"
#include "scene/view_limits.h"
#include "streaming/cut/gray16_png.h"
#include "tests/scene/patch_test_support.h"

namespace terrella::test {
namespace {

constexpr Color kGround = {220, 190, 140};
constexpr Viewport kReliefPicture{128, 128};
// Of the heights below: mountains up to this, basins down to the same.
constexpr double kMost_m = 5000.0;
const TileGrid kPictureGrid{.tile_px = 64, .max_level = 1};
const TileGrid kHeightGrid{.tile_px = 64, .max_level = 3};

/// Mountains 20° apart, which a grid of a third of a degree follows within 8 m.
double height_m(double lat_rad, double lon_rad, double waves = 18.0) {
  return 0.5 * kMost_m * (std::sin(waves * lat_rad) + std::cos(waves * lon_rad) * std::cos(lat_rad));
}

/// The heights as 16-bit tiles, as the cutter writes them: number - 32768 is the height in quarters of a metre.
class Mountains : public TileSource {
 public:
  explicit Mountains(double waves) : waves_(waves) {
    info_.grid = kHeightGrid;
    info_.format = ImageFormat::png;
    info_.elevation = ElevationInfo{.scale = 0.25, .offset = -8192.0, .nodata = {}, .floats = false};
  }
  [[nodiscard]] const TileSetInfo& info() const override { return info_; }
  [[nodiscard]] Result<EncodedTile, TileFailure> read(const TileId& id) override {
    if (!exists(info_.grid, id)) return TileFailure{Absence::absent, "outside"};
    const TileBounds b = tile_bounds(info_.grid, id);
    const int side = info_.grid.tile_px;
    const double pixel_deg = (b.east_deg - b.west_deg) / side, to_rad = std::numbers::pi / 180.0;
    std::vector<std::uint16_t> values;
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) {
        const double lat = (b.north_deg - (y + 0.5) * pixel_deg) * to_rad,
                     lon = (b.west_deg + (x + 0.5) * pixel_deg) * to_rad;
        values.push_back(static_cast<std::uint16_t>(std::lround(4.0 * (height_m(lat, lon, waves_) + 8192.0))));
      }
    }
    return EncodedTile{*encode_gray16_png(values, side)};
  }

 private:
  TileSetInfo info_;
  double waves_;
};

class GlobeRelief : public GlTest {
 protected:
  static std::unique_ptr<Globe> mountains(const GlobeOptions& options, double waves = 18.0) {
    auto heights = ElevationSource::open(std::make_shared<Mountains>(waves), "mountains");
    EXPECT_TRUE(heights) << (heights ? "" : heights.error().message);
    auto globe = Globe::create(options, one_colour(kPictureGrid, kGround), *heights);
    EXPECT_TRUE(globe);
    return std::move(*globe);
  }
};

std::string words_of(const Camera& c, double exaggeration) {
  std::ostringstream out;
  out.precision(12);
  out << c.eye.lat.deg() << ',' << c.eye.lon.deg() << ',' << c.eye.height_m << ',' << c.heading.deg() << ','
      << c.pitch.deg() << ',' << c.fov_y.deg() << " exaggeration " << exaggeration;
  return out.str();
}

/// Whether a ray meets the ground: in steps that are small against its mountains, by the heights themselves.
bool meets_ground(const View& view, const Ellipsoid& body, glm::dvec2 px, double exaggeration) {
  const EcefDir ray = pixel_ray(view, px);
  const double top_m = exaggeration * kMost_m;
  const Ellipsoid over(body.a_m() + top_m, body.f());
  const auto enters = over.intersect_m(view.eye, ray);
  if (!enters) return false;
  // Twice the way down from the highest to the lowest ground, or through to the other side where it is grazed.
  const double reach_m = 2.2 * std::sqrt(2.0 * body.a_m() * 2.0 * top_m) + 4.0 * top_m;
  constexpr int kSteps = 3000;
  for (int k = 0; k <= kSteps; ++k) {
    const Ecef p{view.eye.xyz_m + (*enters + reach_m * k / kSteps) * ray.xyz};
    const Geodetic at = body.to_geodetic(p);
    if (at.height_m < exaggeration * height_m(at.lat.rad(), at.lon.rad())) return true;
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

TEST_F(GlobeRelief, HasNoCrackFromAnywhereHoweverExaggerated) {
  Draw draw(61);
  int cameras = 0;
  for (const double exaggeration : {1.0, 4.0, 20.0}) {
    GlobeOptions options = unlit_options();
    options.exaggeration = exaggeration;
    const auto globe = mountains(options);
    const double top_m = exaggeration * kMost_m;
    const Ellipsoid lowest(earth().ellipsoid.a_m() - top_m, earth().ellipsoid.f());
    for (int k = 0; k < 70 && !HasFailure(); ++k, ++cameras) {
      const Camera camera = random_camera(draw, 1.1 * top_m, 5.0e7);
      globe->set_camera(camera);
      settle(*globe, kReliefPicture);
      const View view = globe->view(kReliefPicture);
      const Picture seen = picture();
      int holes = 0;
      for (int y = 0; y < kReliefPicture.height_px; ++y) {
        for (int x = 0; x < kReliefPicture.width_px; ++x) {
          const EcefDir ray = pixel_ray(view, glm::dvec2(x + 0.5, y + 0.5));
          if (lowest.intersect_m(view.eye, ray) && seen.at(x, y)[0] < 100) ++holes;
        }
      }
      EXPECT_EQ(holes, 0) << words_of(camera, exaggeration);
    }
  }
  EXPECT_EQ(cameras, 210);
}

TEST_F(GlobeRelief, TellsTheHeightThatItDraws) {
  GlobeOptions options = unlit_options();
  options.exaggeration = 3.0;
  const auto globe = mountains(options);
  globe->set_camera(camera_at(10, 20, 3.0e5));
  settle(*globe, kReliefPicture);
  const double lat = 10.2 * std::numbers::pi / 180.0, lon = 20.3 * std::numbers::pi / 180.0;
  // Three times what bilinear heights a third of a degree apart miss.
  EXPECT_NEAR(globe->ground_height_m(Angle::radians(lat), Angle::radians(lon)), 3.0 * height_m(lat, lon), 3.0 * 8.0);
}

TEST_F(GlobeRelief, ThroughATranslucentMountainNoOtherMountainShows) {
  const auto pixels_drawn_twice = [this](bool naive) {
    GlobeOptions options = unlit_options();
    options.exaggeration = 20.0;
    options.surface.alpha = 0.5;
    options.naive_translucency = naive;
    const auto globe = mountains(options, 90.0);  // 4° apart: one behind the other before the horizon
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
