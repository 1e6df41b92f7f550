// Pixels show the place that pick() returns, from 1 m to 100,000 km, in every mode; and pictures do not jitter.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "tests/gl/place_waves.h"
#include "tests/scene/patch_test_support.h"

namespace terrella::test {
namespace {

constexpr Viewport kWindow{48, 48};
// Largest error of the surface and of interpolated coordinates together on the screen.
constexpr double kPlace_px = 0.25;

struct Scene {
  GlobeOptions options = unlit_options();
  TileGrid grid{.tile_px = 64, .max_level = kMaxTileLevel};
  Camera camera;
};

/// Width of a pixel in the middle of the picture on the unit sphere, across the line of sight.
double pixel_on_sphere(const Scene& scene) {
  const double distance_m = scene.camera.eye.height_m / std::sin(std::abs(scene.camera.pitch.rad()));
  return 2.0 * distance_m * std::tan(0.5 * scene.camera.fov_y.rad()) /
         (kWindow.height_px * scene.options.body.ellipsoid.a_m());
}

class GlobePlace : public GlTest {
 protected:
  static PlaceWaves waves_of(const Scene& scene) {
    const Ellipsoid& ellipsoid = scene.options.body.ellipsoid;
    const auto middle = pick(make_view(scene.camera, ellipsoid, kWindow), ellipsoid, {24.0, 24.0});
    return {scene.grid, ellipsoid, middle.value(), pixel_on_sphere(scene)};
  }

  std::unique_ptr<Globe> globe_of(const Scene& scene, const PlaceWaves& waves) {
    return make_globe(scene.options, std::make_shared<PaintedSource>(scene.grid, [waves](double lon, double row) {
                        return waves.paint(lon, row);
                      }));
  }

  WaveError error_at(Globe& globe, const Camera& camera, const PlaceWaves& waves) {
    globe.set_camera(camera);
    settle(globe, kWindow);
    return wave_error(picture(), globe.view(kWindow), globe.options().body.ellipsoid, waves);
  }

  void check(const Scene& scene, const std::string& what) {
    const Camera& c = scene.camera;
    SCOPED_TRACE(testing::Message() << what << " camera " << c.eye.lat.deg() << ',' << c.eye.lon.deg() << ','
                                    << c.eye.height_m << ',' << c.heading.deg() << ',' << c.pitch.deg());
    const PlaceWaves waves = waves_of(scene);
    const WaveError error = error_at(*globe_of(scene, waves), c, waves);
    EXPECT_GT(error.pixels, kWindow.width_px * kWindow.height_px / 2) << "too little was judged";
    EXPECT_LE(error.usual_px, kPlace_px) << "the farthest off is " << error.most_px;
  }
};

TEST_F(GlobePlace, IsExactFromOneMetreToAHundredThousandKilometres) {
  for (const double height_m : {1.0, 30.0, 1.0e3, 3.0e3, 1.0e5, 2.0e6, 1.0e7, 1.0e8}) {
    // From afar the globe must still fill the picture.
    const double fov = height_m > 5.0e6 ? 40.0 * 3.0e6 / height_m : 40.0;
    check({.camera = camera_at(47.3, 8.5, height_m, 30, -90, fov)}, "inland");
    check({.camera = camera_at(-12.0, 180.0, height_m, 0, -90, fov)}, "antimeridian");
    check({.camera = camera_at(-12.0, 179.9, height_m, 0, -90, fov)}, "beside the antimeridian");
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
  for (const Texturing texturing : {Texturing::automatic, Texturing::vertex, Texturing::paper, Texturing::exact}) {
    for (const DepthMode depth : {DepthMode::reversed, DepthMode::logarithmic, DepthMode::standard}) {
      Scene scene{.camera = camera};
      scene.options.texturing = texturing;
      scene.options.depth = depth;
      check(scene, "mode");
    }
  }
  for (const Texturing texturing : {Texturing::automatic, Texturing::vertex, Texturing::exact}) {
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

TEST_F(GlobePlace, IsExactWithCoordinatesForEachFragment) {
  for (const double height_m : {1.0, 1.0e3, 1.0e5, 5.0e5}) {
    for (const double lat : {30.0, -30.0}) {
      Scene scene{.camera = camera_at(lat, lat > 0.0 ? 60.0 : -60.0, height_m, 15, -80)};
      scene.options.texturing = Texturing::exact;
      scene.grid.tile_px = 256;
      check(scene, "exact");
    }
  }
}

TEST_F(GlobePlace, MovesAsTheEyeMovesWithoutJitter) {
  constexpr double kJitter_px = 0.05;
  // A patch that gives way to a coarser one is bent a little otherwise: on this way, which is 4 px long, that may
  // happen once.
  constexpr double kPatch_px = 0.1;
  for (const double height_m : {1.0, 10.0, 100.0, 1.0e4, 1.0e6}) {
    const Scene scene{.camera = camera_at(47.123, 8.456, height_m)};
    const double pixel = pixel_on_sphere(scene);
    const PlaceWaves waves = waves_of(scene);
    const auto globe = globe_of(scene, waves);
    Camera moved = scene.camera;
    WaveError before = error_at(*globe, moved, waves);
    int switches = 0;
    for (int k = 1; k <= 60; ++k) {
      SCOPED_TRACE(testing::Message() << "height " << height_m << " step " << k);
      // Steps that the picture hardly shows, then steps that it must show.
      const double step = (k <= 30 ? 0.001 : 0.08) * pixel;
      moved.eye.lon = moved.eye.lon + Angle::radians(step / std::cos(moved.eye.lat.rad()));
      moved.eye.lat = moved.eye.lat + Angle::radians(0.7 * step);
      const WaveError now = error_at(*globe, moved, waves);
      ASSERT_GT(now.pixels, 1000) << "nothing was judged";
      ASSERT_LE(now.usual_px, kPlace_px) << "off its place";
      ASSERT_LE(glm::length(now.mean_px), kPatch_px) << "off its place";
      if (glm::distance(now.mean_px, before.mean_px) > kJitter_px) ++switches;
      before = now;
    }
    EXPECT_LE(switches, 1) << "it jitters, height " << height_m;
  }
}

}  // namespace
}  // namespace terrella::test
