// What is drawn at a pixel is what pick() says is there, from 1 m to 100,000 km, in every mode; and it does not jitter.
#include <gtest/gtest.h>

#include <cmath>

#include "place_code.h"
#include "tests/scene/patch_test_support.h"

namespace terrella::test {
namespace {

constexpr Viewport kWindow{48, 48};
// A quarter of a pixel for the engine; eight bits spread over 77 pixels, rounded in the tile and again in the picture,
// blur a place by.
constexpr double kPlace_px = 0.25 + 0.3;

struct Scene {
  GlobeOptions options = unlit_options();
  TileGrid grid{.tile_px = 64, .max_level = 22};
  Camera camera;
};

/// Half of what the picture spans on the unit sphere, at its middle; the whole disc at most.
double half_span(const Scene& scene) {
  const double a = scene.options.body.ellipsoid.a_m();
  const double distance_m = scene.camera.eye.height_m / std::sin(std::abs(scene.camera.pitch.rad()));
  return std::min(0.9, 1.6 * distance_m * std::tan(0.5 * scene.camera.fov_y.rad()) / a);
}

std::optional<Geodetic> middle(const Scene& scene) {
  return pick(make_view(scene.camera, scene.options.body.ellipsoid, kWindow), scene.options.body.ellipsoid,
              {24.0, 24.0});
}

class GlobePlace : public GlTest {
 protected:
  std::unique_ptr<Globe> globe_of(const Scene& scene, const PlaceCode& code) {
    auto source =
        std::make_shared<PaintedSource>(scene.grid, [code](double lon, double row) { return code.paint(lon, row); });
    auto globe = make_globe(scene.options, std::move(source));
    globe->set_camera(scene.camera);
    settle(*globe, kWindow);
    return globe;
  }

  void check(const Scene& scene, const std::string& what) {
    const Camera& c = scene.camera;
    SCOPED_TRACE(testing::Message() << what << " camera " << c.eye.lat.deg() << ',' << c.eye.lon.deg() << ','
                                    << c.eye.height_m << ',' << c.heading.deg() << ',' << c.pitch.deg());
    const auto center = middle(scene);
    ASSERT_TRUE(center);
    const PlaceCode code(scene.grid, scene.options.body.ellipsoid, *center, half_span(scene));
    const auto globe = globe_of(scene, code);
    const PlaceError error = place_error(picture(), globe->view(kWindow), scene.options.body.ellipsoid, code);
    EXPECT_GT(error.pixels, 400);
    EXPECT_LE(error.most_px, kPlace_px);
  }
};

TEST_F(GlobePlace, IsExactFromOneMetreToAHundredThousandKilometres) {
  for (const double height_m : {1.0, 30.0, 3.0e3, 1.0e5, 2.0e6, 1.0e7, 1.0e8}) {
    // From afar the globe must still fill the picture.
    const double fov = height_m > 5.0e6 ? 40.0 * 3.0e6 / height_m : 40.0;
    check({.camera = camera_at(47.3, 8.5, height_m, 30, -90, fov)}, "inland");
    check({.camera = camera_at(-12.0, 180.0, height_m, 0, -90, fov)}, "antimeridian");
    // A patch that touches a pole takes no more than so many tiles across, which bounds its detail.
    if (height_m < 1.0e6) continue;
    check({.camera = camera_at(90.0, 0.0, height_m, 20, -90, fov)}, "pole");
    check({.camera = camera_at(-89.5, 100.0, height_m, 0, -90, fov)}, "beside the pole");
  }
}

TEST_F(GlobePlace, IsExactInObliqueViews) {
  check({.camera = camera_at(47.3, 8.5, 500.0, 120, -45)}, "inland");
  check({.camera = camera_at(35.26438968, 45.0, 1.0e5, 250, -55)}, "cube corner");
  check({.camera = camera_at(80.0, 180.0, 4.0e5, 0, -50)}, "near the pole");
}

TEST_F(GlobePlace, IsTheSameInEveryModeDepthProjectionAndLatitude) {
  const Camera camera = camera_at(44.0, 20.0, 3.0e5, 15, -70);
  for (const Texturing texturing : {Texturing::automatic, Texturing::vertex, Texturing::paper}) {
    for (const DepthMode depth : {DepthMode::reversed, DepthMode::logarithmic, DepthMode::standard}) {
      Scene scene{.camera = camera};
      scene.options.texturing = texturing;
      scene.options.depth = depth;
      check(scene, "mode");
    }
  }
  for (const Texturing texturing : {Texturing::automatic, Texturing::vertex}) {
    for (const Projection projection : {Projection::equirectangular, Projection::equal_area}) {
      for (const LatitudeKind kind : {LatitudeKind::graphic, LatitudeKind::centric}) {
        Scene scene{.camera = camera};
        scene.options.texturing = texturing;
        scene.options.body = *parse_body("6378137,0.098");
        scene.grid.projection = projection;
        scene.grid.latitude = kind;
        check(scene, "grid");
        scene.camera = camera_at(-44.0, -20.0, 3.0e5, 15, -90);
        check(scene, "grid");
      }
    }
  }
}

TEST_F(GlobePlace, IsExactOnTilesOfAnyRootSpan) {
  for (const double span : {288.0, 256.0 * 64.0 / 60.0, 360.0}) {
    for (const double lon : {20.0, 179.9}) {
      Scene scene{.camera = camera_at(44.0, lon, 3.0e5, 15, -90)};
      scene.grid.root_span_deg = span;
      check(scene, "root span");
    }
  }
}

int largest_step(const Picture& a, const Picture& b) {
  int worst = 0;
  for (int y = 0; y < a.size.height_px; ++y) {
    for (int x = 0; x < a.size.width_px; ++x) {
      // Away from the ends of the scale.
      const Color p = a.at(x, y), q = b.at(x, y);
      if (p[0] < 20 || p[0] > 235 || p[1] < 20 || p[1] > 235) continue;
      worst = std::max({worst, std::abs(p[0] - q[0]), std::abs(p[1] - q[1])});
    }
  }
  return worst;
}

TEST_F(GlobePlace, DoesNotJitterWhenTheEyeMovesByAThousandthOfAPixel) {
  // Full scale over six pixels: 42 levels a pixel, so that 0.05 px is two levels.
  constexpr double kPixels = 6.0;
  constexpr int kLevels = 2;
  for (const double height_m : {1.0, 100.0, 1.0e4, 1.0e6}) {
    Scene scene{.camera = camera_at(47.123, 8.456, height_m)};
    scene.grid.max_level = kMaxTileLevel;
    const double pixel_on_sphere = 2.0 * half_span(scene) / kWindow.height_px;
    const PlaceCode code(scene.grid, earth().ellipsoid, scene.camera.eye, 0.5 * kPixels * pixel_on_sphere);
    const auto globe = globe_of(scene, code);
    Picture before = picture();
    int coded = 0;
    for (int k = 1; k <= 60; ++k) {
      Camera moved = scene.camera;
      const double step = 0.001 * k * pixel_on_sphere;
      moved.eye.lon = moved.eye.lon + Angle::radians(step / std::cos(moved.eye.lat.rad()));
      moved.eye.lat = moved.eye.lat + Angle::radians(0.7 * step);
      globe->set_camera(moved);
      settle(*globe, kWindow);
      const Picture now = picture();
      ASSERT_LE(largest_step(before, now), kLevels) << "height " << height_m << " step " << k;
      before = now;
    }
    for (int y = 0; y < kWindow.height_px; ++y) {
      for (int x = 0; x < kWindow.width_px; ++x) coded += code.place(before.at(x, y)) ? 1 : 0;
    }
    EXPECT_GT(coded, 9) << "nothing was judged";
  }
}

}  // namespace
}  // namespace terrella::test
