// Hard cases: each pixel shows what a ray in double finds there.
#include <cmath>

#include "apps/bench/stability/place_errors.h"
#include "tests/gl/gl_context_test.h"

namespace terrella::bench {
namespace {

// Largest error of the surface and of coordinates on the screen.
constexpr double kPlace_px = 0.25;
constexpr double kMoon_m = 3.844e8;
constexpr double kCubeCorner_deg = 35.264389682754654;  // latitude at which |x| = |y| = |z|

Camera camera_at(double lat_deg, double lon_deg, double height_m, double heading_deg = 0.0, double pitch_deg = -90.0,
                 double fov_deg = 40.0) {
  return {.eye = {.lat = Angle::degrees(lat_deg), .lon = Angle::degrees(lon_deg), .height_m = height_m},
          .heading = Angle::degrees(heading_deg),
          .pitch = Angle::degrees(pitch_deg),
          .fov_y = Angle::degrees(fov_deg)};
}

class HardCases : public test::GlContextTest {
 protected:
  void SetUp() override {
    GlContextTest::SetUp();
    const auto functions = choose_shader_functions();
    ASSERT_TRUE(functions) << functions.error().message;
    auto probe = PatchProbe::create(*functions);
    ASSERT_TRUE(probe) << probe.error().message;
    probe_.emplace(*std::move(probe));
  }
  void TearDown() override {
    probe_.reset();
    GlContextTest::TearDown();
  }

  void expect_in_place(const Camera& camera, Viewport size = {96, 96}, const Body& body = earth(),
                       bool something = true) {
    PatchScene scene(camera, size, kMaxTileLevel, body);
    const PlaceErrors errors = place_errors(scene, *probe_);
    const Geodetic& eye = camera.eye;
    SCOPED_TRACE(testing::Message() << body.name << ", camera " << eye.lat.deg() << ',' << eye.lon.deg() << ','
                                    << eye.height_m << ',' << camera.heading.deg() << ',' << camera.pitch.deg() << ','
                                    << camera.fov_y.deg());
    EXPECT_LE(errors.drawn_px, kPlace_px);
    EXPECT_EQ(errors.holes, 0);
    EXPECT_EQ(errors.judged > 0, something);
  }

  std::optional<PatchProbe> probe_;
};

TEST_F(HardCases, FromAMetreToTheMoonAndBackInOneRun) {
  for (const double height_m : {1.0, 1.0e3, 1.0e6, kMoon_m, 1.0e6, 1.0e3, 1.0}) {
    expect_in_place(camera_at(47.0, 8.0, height_m, 30.0, -90.0, height_m == kMoon_m ? 2.0 : 40.0));
  }
}

TEST_F(HardCases, OverAPoleWithAnyHeading) {
  for (const double lat : {90.0, -90.0}) {
    for (double heading = 0.0; heading < 360.0; heading += 37.0) {
      expect_in_place(camera_at(lat, 0.0, 5.0e6, heading));
      expect_in_place(camera_at(lat, 123.0, 3.0e3, heading, -60.0));
    }
  }
}

TEST_F(HardCases, OnTheAntimeridianOnCubeEdgesAndOnCorners) {
  for (const double lon : {180.0, -180.0, 45.0, -135.0}) {
    for (const double lat : {0.0, kCubeCorner_deg, -kCubeCorner_deg}) {
      for (const double height_m : {2.0, 1.0e4, 8.0e6}) expect_in_place(camera_at(lat, lon, height_m, 10.0, -70.0));
    }
  }
}

TEST_F(HardCases, GrazingTheHorizonStraightDownAndStraightUp) {
  for (const double height_m : {1.0, 100.0, 1.0e4, 1.0e6}) {
    const double dip_deg = Angle::radians(std::acos(1.0 / (1.0 + height_m / earth().ellipsoid.a_m()))).deg();
    expect_in_place(camera_at(30.0, 20.0, height_m, 200.0, -dip_deg));
    expect_in_place(camera_at(30.0, 20.0, height_m, 200.0, -90.0));
    expect_in_place(camera_at(30.0, 20.0, height_m, 200.0, 90.0), {96, 96}, earth(), false);
  }
}

TEST_F(HardCases, ThroughTheLongestAndTheWidestLens) {
  for (const double fov : {1.0, 120.0}) {
    for (const double pitch : {-90.0, -30.0}) {
      for (const double height_m : {2.0, 1.0e5}) expect_in_place(camera_at(-33.0, 151.0, height_m, 77.0, pitch, fov));
    }
  }
}

TEST_F(HardCases, InAWindowOfOnePixelAndInOneThatIsAThousandTimesAsWideAsHigh) {
  expect_in_place(camera_at(47.0, 8.0, 2.0e3), {1, 1});
  expect_in_place(camera_at(47.0, 8.0, 2.0e6), {16384, 16});
}

TEST_F(HardCases, OnBodiesFromPhobosToSaturn) {
  for (const char* name : {"phobos", "moon", "mars", "jupiter", "saturn"}) {
    const Body body = *parse_body(name);
    for (const double lat : {90.0, 45.0, 0.0}) {
      expect_in_place(camera_at(lat, 180.0, 0.5 * body.ellipsoid.a_m(), 20.0), {96, 96}, body);
      expect_in_place(camera_at(lat, 180.0, 10.0, 20.0, -50.0), {96, 96}, body);
    }
  }
}

}  // namespace
}  // namespace terrella::bench
