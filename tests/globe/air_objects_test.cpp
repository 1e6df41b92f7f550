// The air before objects, by their distance, beside marched rays.
#include <gtest/gtest.h>

#include "air_fixture.h"

namespace terrella::test {
namespace {

class AirOverObjects : public AirPictures {
 protected:
  /// A ball of 9 pixels' radius along the ray through the picture's middle.
  void place_ball(Globe& globe, const View& view, double distance_m) {
    const Ecef place{view.eye.xyz_m + distance_m * view.forward};
    globe_ball_ = {.place = earth().ellipsoid.to_geodetic(place),
                   .radius_m = 9.0 * distance_m / view.pixels_per_radian(),
                   .color = {200, 60, 30, 255}};
    if (layer_) {
      ASSERT_TRUE(globe.remove(*layer_).ok());
    }
    const auto added = globe.add_objects({.points = {globe_ball_}});
    ASSERT_TRUE(added) << added.error().message;
    layer_ = *added;
  }
  [[nodiscard]] glm::dvec3 middle(Globe& globe, bool sky) {
    globe.set_sky(sky);
    settle(globe, kSize);
    const Color c = picture().at(kSize.width_px / 2, kSize.height_px / 2);
    return {c[0], c[1], c[2]};
  }
  PointObject globe_ball_;
  std::optional<LayerId> layer_;
};

TEST_F(AirOverObjects, IsThatOfMarchedRays) {
  constexpr double kOff_levels = 8.0;
  const AirTruth truth(*atmosphere_of(earth()), earth().ellipsoid);
  const auto globe = globe_with_air(earth(), 90);
  struct Case {
    double eye_m, pitch_deg, distance_m;
  };
  double most = 0.0;
  for (const Case& c :
       {Case{2.0e3, -1.0, 3.0e3}, Case{2.0e3, -1.0, 2.0e4}, Case{2.0e3, -1.0, 8.0e4}, Case{100.0, 3.0, 3.0e4},
        Case{1.0e4, -5.0, 6.0e4}, Case{2.0e5, -13.0, 7.0e5}, Case{2.0e6, -60.0, 1.5e6}}) {
    SCOPED_TRACE("from " + std::to_string(c.eye_m) + " m, " + std::to_string(c.distance_m) + " m away");
    const AirView v{c.eye_m, 40.0, 60.0, c.pitch_deg, 40.0};
    globe->set_camera(camera(v));
    const View view = make_view(camera(v), earth().ellipsoid, kSize);
    place_ball(*globe, view, c.distance_m);
    const glm::dvec3 own = middle(*globe, false), seen = middle(*globe, true);
    const double near_m = c.distance_m - globe_ball_.radius_m;
    const glm::dvec3 expected = truth.thing(view.eye.xyz_m, view.forward, near_m, almanac_.sun.xyz, own);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(seen[k], expected[k], kOff_levels) << "channel " << k << " of " << own[k];
    most = std::max(most, glm::distance(own, seen));
  }
  EXPECT_GT(most, 40.0) << "no air";
}

}  // namespace
}  // namespace terrella::test
