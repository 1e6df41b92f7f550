// Picks and projections through the façade where the ground is mountains: from anywhere, over poles, on ±180°, grazing.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "tests/gl/gl_fixture.h"
#include "tests/gl/painted_heights.h"
#include "tests/scene/patch_test_support.h"

namespace terrella::test {
namespace {

constexpr Viewport kRugged{80, 60};
// A picked place is drawn within a tenth of a pixel of the pixel that was picked.
constexpr double kThereAndBack_px = 0.1;
// Ground that is nearer by less than this share may hide a place or not: the ray grazes a ridge.
constexpr double kNearer = 0.01;

// Mountains 6° apart and smaller ones on them, which tiles of a sixth of a degree a pixel follow.
double rugged_m(double lat_rad, double lon_rad) {
  return 3000.0 * std::sin(60.0 * lat_rad) * std::cos(60.0 * lon_rad) * std::cos(lat_rad) +
         500.0 * std::sin(211.0 * lat_rad + 97.0 * lon_rad) * std::cos(lat_rad);
}

class ReliefPicks : public GlTest, public testing::WithParamInterface<double> {
 protected:
  void SetUp() override {
    GlTest::SetUp();
    GlobeOptions options = unlit_options();
    options.exaggeration = GetParam();
    options.relief_meshes_per_frame = 10000;
    options.max_error_px = 4.0;  // nobody looks at the picture
    auto heights = ElevationSource::open(painted_heights({.tile_px = 128, .max_level = 3}, rugged_m), "rugged");
    ASSERT_TRUE(heights) << heights.error().message;
    auto globe = Globe::create(options, one_colour({.tile_px = 16, .max_level = 1}, {10, 20, 30}), *heights);
    ASSERT_TRUE(globe) << globe.error().message;
    globe_ = std::move(*globe);
  }
  void TearDown() override {
    globe_.reset();
    GlTest::TearDown();
  }

  /// Low or high over the ground; one in three over a pole or on ±180°.
  void look_from(Draw& draw, int k) {
    Camera camera = camera_at(draw.between(-80.0, 80.0), draw.between(-180.0, 180.0), 0.0, draw.between(0.0, 360.0),
                              draw.between(-60.0, -1.0), draw.whole(0, 3) == 0 ? 5.0 : 40.0);
    if (k % 6 == 1) camera.eye.lat = Angle::degrees(draw.whole(0, 1) == 0 ? 90.0 : -89.99);
    if (k % 6 == 4) camera.eye.lon = Angle::degrees(draw.whole(0, 1) == 0 ? 180.0 : -179.995);
    // The tiles stray from what is painted by a few metres.
    const double over_m = 40.0 * GetParam() + std::exp(draw.between(std::log(100.0), std::log(2.0e6)));
    camera.eye.height_m = GetParam() * rugged_m(camera.eye.lat.rad(), camera.eye.lon.rad()) + over_m;
    globe_->set_camera(camera);
    settle(*globe_, kRugged);
  }

  [[nodiscard]] double distance_m(const Geodetic& place) const {
    const Ellipsoid& body = globe_->options().body.ellipsoid;
    return glm::distance(body.to_ecef(place).xyz_m, globe_->view(kRugged).eye.xyz_m);
  }

  /// The place that a pixel shows, if any, and back.
  [[nodiscard]] std::optional<Geodetic> go_there_and_back(glm::dvec2 px) const {
    const auto place = globe_->pick(px, kRugged).place;
    if (!place) return place;
    const double ground_m = globe_->ground_height_m(place->lat, place->lon);
    EXPECT_NEAR(place->height_m, ground_m, 1e-3 * GetParam() + 1e-6 * distance_m(*place)) << "not on the ground";
    const auto back = globe_->project(*place, kRugged);
    EXPECT_TRUE(back) << px.x << ' ' << px.y << " is hidden from itself";
    EXPECT_LT(glm::distance(back.value_or(px), px), kThereAndBack_px) << px.x << " " << px.y;
    return place;
  }

  /// A place of the ground is projected where it is seen, and only there; false if it is neither clearly.
  [[nodiscard]] bool is_shown_or_hidden(const Geodetic& place, int& hidden) const {
    const Ellipsoid& body = globe_->options().body.ellipsoid;
    const auto raw = terrella::project(globe_->view(kRugged), body.to_ecef(place));
    if (!raw || raw->x < 0.0 || raw->y < 0.0 || raw->x > kRugged.width_px || raw->y > kRugged.height_px) return false;
    const auto seen = globe_->pick(*raw, kRugged).place;
    if (!seen) return false;  // a ridge against the sky, from its far side
    const double nearer = distance_m(*seen) / distance_m(place);
    const auto pixel = globe_->project(place, kRugged);
    if (nearer < 1.0 - kNearer) {
      ++hidden;
      EXPECT_FALSE(pixel) << "shown through a mountain at " << nearer << " of its distance";
      return true;
    }
    if (std::abs(nearer - 1.0) > 1e-6) return false;
    EXPECT_TRUE(pixel);
    return pixel && glm::distance(*pixel, *raw) < kThereAndBack_px;
  }

  /// A place on the ground around another one: before a mountain, on it or behind it.
  [[nodiscard]] Geodetic place_around(Draw& draw, const Geodetic& place) const {
    const double aside = 2.0e-6 * distance_m(place) * std::exp(draw.between(-3.0, 3.0));
    const double lat = std::clamp(place.lat.deg() + aside * draw.between(-5.0, 5.0), -90.0, 90.0);
    const Angle lon = Angle::degrees(place.lon.deg() + aside * draw.between(-5.0, 5.0));
    Geodetic other{.lat = Angle::degrees(lat), .lon = lon, .height_m = 0.0};
    other.height_m = globe_->ground_height_m(other.lat, other.lon);
    return other;
  }

  std::unique_ptr<Globe> globe_;
};

TEST_P(ReliefPicks, ProjectionsInvertThemAndMountainsHideWhatIsBehind) {
  constexpr int kCameras = 6, kPixels = 40, kAround = 4;
  Draw draw(11);
  int found = 0, judged = 0, hidden = 0;
  for (int k = 0; k < kCameras; ++k) {
    look_from(draw, k);
    for (int p = 0; p < kPixels; ++p) {
      const auto place = go_there_and_back({draw.between(0.0, kRugged.width_px), draw.between(0.0, kRugged.height_px)});
      if (!place) continue;
      ++found;
      for (int n = 0; n < kAround; ++n) judged += is_shown_or_hidden(place_around(draw, *place), hidden) ? 1 : 0;
    }
  }
  RecordProperty("found", found);
  RecordProperty("judged", judged);
  RecordProperty("hidden", hidden);
  EXPECT_GT(found, kCameras * kPixels / 2);
  EXPECT_GT(judged, found / 3);
  EXPECT_GT(hidden, 0);
}

INSTANTIATE_TEST_SUITE_P(Exaggerations, ReliefPicks, testing::Values(1.0, 5.0, 20.0));

}  // namespace
}  // namespace terrella::test
