#include "geo/camera.h"

#include "geo/place_text.h"

#include <gtest/gtest.h>

#include <array>
#include <numbers>

#include "geo_test_support.h"

namespace terrella {
namespace {

using test::Draw;
using test::kEpsilon;
using test::kInfinity;
using test::kNaN;

// Sines, cosines and two products of unit vectors.
constexpr double kDirectionError = 8.0 * kEpsilon;

Camera camera_at(double lat, double lon, double height_m, double heading = 0.0, double pitch = -90.0,
                 double fov = 40.0) {
  return {.eye = {.lat = Angle::degrees(lat), .lon = Angle::degrees(lon), .height_m = height_m},
          .heading = Angle::degrees(heading),
          .pitch = Angle::degrees(pitch),
          .fov_y = Angle::degrees(fov)};
}

View view_of(const Camera& camera, Viewport viewport = {1024, 768}) {
  return make_view(camera, earth().ellipsoid, viewport);
}

void expect_near(const glm::dvec3& a, const glm::dvec3& b) {
  EXPECT_LE(glm::distance(a, b), kDirectionError) << a.x << ' ' << a.y << ' ' << a.z;
}

TEST(Camera, ViewIsOrthonormalEverywhere) {
  for (const double lat : {-90.0, -45.0, 0.0, 30.0, 89.9999999, 90.0}) {
    for (const double lon : {-180.0, 0.0, 12.0, 180.0, 540.0}) {
      for (const double heading : {0.0, 90.0, 217.0, -1000.0}) {
        for (const double pitch : {-90.0, -30.0, 0.0, 90.0}) {
          const View view = view_of(camera_at(lat, lon, 1e3, heading, pitch));
          expect_near(glm::cross(view.right, view.up), -view.forward);
          EXPECT_NEAR(glm::length(view.right), 1.0, kDirectionError);
          EXPECT_NEAR(glm::length(view.forward), 1.0, kDirectionError);
          EXPECT_NEAR(glm::dot(view.right, view.forward), 0.0, kDirectionError);
        }
      }
    }
  }
}

TEST(Camera, HeadingRunsClockwiseFromNorthAndPitchUp) {
  // At 0°N 0°E east is +y, north is +z, up is +x.
  expect_near(view_of(camera_at(0, 0, 0, 0, 0)).forward, {0, 0, 1});
  expect_near(view_of(camera_at(0, 0, 0, 90, 0)).forward, {0, 1, 0});
  expect_near(view_of(camera_at(0, 0, 0, 90, 0)).right, {0, 0, -1});
  expect_near(view_of(camera_at(0, 0, 0, 0, 90)).forward, {1, 0, 0});
  expect_near(view_of(camera_at(0, 0, 0, 0, -90)).forward, {-1, 0, 0});
}

TEST(Camera, StraightDownHeadingSaysWhatIsUpInThePicture) {
  expect_near(view_of(camera_at(0, 0, 1e6, 0, -90)).up, {0, 0, 1});
  expect_near(view_of(camera_at(0, 0, 1e6, 90, -90)).up, {0, 1, 0});
  // Over the north pole on the meridian of 90° E, north lies ahead across the pole, towards 90° W.
  expect_near(view_of(camera_at(90, 90, 1e6, 0, -90)).up, {0, -1, 0});
  expect_near(view_of(camera_at(90, 90, 1e6, 0, -90)).forward, {0, 0, -1});
  expect_near(view_of(camera_at(-90, 0, 1e6, 0, -90)).up, {1, 0, 0});
}

TEST(Camera, RotationTakesTheAxesToTheViewsOwn) {
  const View view = view_of(camera_at(46, 7, 3e5, 30, -20));
  const glm::dmat3 view_from_ecef = view_from_ecef_rotation(view);
  expect_near(view_from_ecef * view.right, {1, 0, 0});
  expect_near(view_from_ecef * view.up, {0, 1, 0});
  expect_near(view_from_ecef * view.forward, {0, 0, -1});
}

TEST(Camera, RaysFollowPixels) {
  const View view = view_of(camera_at(10, 20, 1e7, 15, -60, 40), {1024, 768});
  expect_near(pixel_ray(view, {512, 384}).xyz, view.forward);
  const auto angle = [&](glm::dvec2 px) { return std::acos(glm::dot(pixel_ray(view, px).xyz, view.forward)); };
  // Half the field of view at the upper edge; an arc cosine there loses no more than a few ulps.
  EXPECT_NEAR(angle({512, 0}), Angle::degrees(20).rad(), 16.0 * kEpsilon);
  EXPECT_GT(glm::dot(pixel_ray(view, {512, 0}).xyz, view.up), 0.0);
  EXPECT_GT(glm::dot(pixel_ray(view, {1024, 384}).xyz, view.right), 0.0);
  EXPECT_NEAR(std::tan(angle({1024, 384})), view.tan_half_fov_y * view.aspect(), 16.0 * kEpsilon);
  // One pixel at the centre; the ray's slope and its angle differ in the third order only, 1e-9 here.
  EXPECT_NEAR(glm::dot(pixel_ray(view, {513, 384}).xyz, view.right) * view.pixels_per_radian(), 1.0, 1e-6);
}

TEST(Camera, StraightDownPicksThePlaceBelow) {
  Draw draw(51);
  for (const Body& body : test::test_bodies()) {
    for (int k = 0; k < 100; ++k) {
      const Camera camera =
          camera_at(draw.between(-90, 90), draw.between(-180, 180), 0.2 * body.ellipsoid.a_m(), draw.between(0, 360));
      const View view = make_view(camera, body.ellipsoid, {101, 55});
      const std::optional<Geodetic> below = pick(view, body.ellipsoid, {50.5, 27.5});
      ASSERT_TRUE(below.has_value());
      // The ray's own rounding over 0.2 radii and the latitude's.
      EXPECT_LE(glm::distance(body.ellipsoid.to_ecef(*below).xyz_m,
                              body.ellipsoid.to_ecef({.lat = camera.eye.lat, .lon = camera.eye.lon}).xyz_m),
                16.0 * kEpsilon * body.ellipsoid.a_m());
      EXPECT_EQ(below->height_m, 0.0);
    }
  }
}

TEST(Camera, PickAndProjectAreInverse) {
  // A place is known to 2 ulps of Earth's radius across the line of sight, 2 nm; at 10 m a pixel of this picture is
  // 7 mm wide, so 2 nm is 3e-7 of it, and less from higher up.
  constexpr double kPixelError = 1e-6;
  Draw draw(52);
  const Viewport viewport{1024, 1024};
  int picked = 0;
  for (int k = 0; k < 20000; ++k) {
    const double height_m = std::exp(draw.between(std::log(10.0), std::log(1e9)));
    const Camera camera = camera_at(draw.between(-90, 90), draw.between(-180, 180), height_m, draw.between(0, 360),
                                    draw.between(-90, 10));
    const View view = view_of(camera, viewport);
    const glm::dvec2 pixel(draw.between(0, 1024), draw.between(0, 1024));
    const std::optional<Geodetic> place = pick(view, earth().ellipsoid, pixel);
    if (!place) continue;
    ++picked;
    const std::optional<glm::dvec2> back = project(view, earth().ellipsoid.to_ecef(*place));
    ASSERT_TRUE(back.has_value());
    EXPECT_LE(glm::distance(*back, pixel), kPixelError) << k << " height " << height_m;
  }
  EXPECT_GT(picked, 3000);
}

TEST(Camera, HardPlacesPickAndProject) {
  struct Case {
    Camera camera;
    Viewport viewport;
  };
  const std::array cases = {
      Case{camera_at(90, 0, 1e6, 33), {1, 1}},
      Case{camera_at(-90, 170, 1e6, 33), {16384, 16}},
      Case{camera_at(0, 180, 6e6), {512, 512}},
      Case{camera_at(0, -180, 3.8e8, 0, -90, 1), {512, 512}},
      Case{camera_at(45, 45, 1e5, 10, -80, 120), {640, 480}},
  };
  for (const Case& c : cases) {
    const View view = view_of(c.camera, c.viewport);
    const glm::dvec2 middle(0.5 * c.viewport.width_px, 0.5 * c.viewport.height_px);
    const std::optional<Geodetic> place = pick(view, earth().ellipsoid, middle);
    ASSERT_TRUE(place.has_value());
    const std::optional<glm::dvec2> back = project(view, earth().ellipsoid.to_ecef(*place));
    ASSERT_TRUE(back.has_value());
    EXPECT_LE(glm::distance(*back, middle), 1e-6);  // as above: nanometres against pixels of metres
  }
}

TEST(Camera, FromInsideTheFarWallIsPicked) {
  const Ellipsoid& e = earth().ellipsoid;
  const View from_centre = make_view(camera_at(0, 0, -e.a_m(), 0, 90), e, {100, 100});
  const std::optional<Geodetic> above = pick(from_centre, e, {50, 50});
  ASSERT_TRUE(above.has_value());
  EXPECT_NEAR(above->lat.deg(), 0.0, 1e-12);  // 0.1 µm on the ground
  EXPECT_NEAR(above->lon.deg(), 0.0, 1e-12);
  const std::optional<Geodetic> through = pick(view_of(camera_at(0, 0, -1000.0)), e, {512, 384});
  ASSERT_TRUE(through.has_value());
  EXPECT_EQ(through->lon.deg(), 180.0);
}

TEST(Camera, BesideTheGlobeAndBehindTheEyeIsNothing) {
  const View view = view_of(camera_at(0, 0, 1e9));
  EXPECT_FALSE(pick(view, earth().ellipsoid, {0, 0}).has_value());
  EXPECT_FALSE(pick(view_of(camera_at(0, 0, 1e6, 0, 90)), earth().ellipsoid, {512, 384}).has_value());
  EXPECT_FALSE(project(view, Ecef{{2e9, 0, 0}}).has_value());
  EXPECT_FALSE(project(view, view.eye).has_value());
  EXPECT_FALSE(project(view, Ecef{{view.eye.xyz_m.x, 1.0, 0}}).has_value());
}

TEST(Camera, WhatIsNotFinitePicksAndProjectsNothing) {
  for (const double bad : {kNaN, kInfinity, -kInfinity}) {
    EXPECT_FALSE(pick(view_of(camera_at(bad, 0, 1e6)), earth().ellipsoid, {512, 384}).has_value());
    EXPECT_FALSE(pick(view_of(camera_at(0, 0, bad)), earth().ellipsoid, {512, 384}).has_value());
    EXPECT_FALSE(pick(view_of(camera_at(0, 0, 1e6)), earth().ellipsoid, {bad, 384}).has_value());
    EXPECT_FALSE(project(view_of(camera_at(0, 0, 1e6)), Ecef{{0, bad, 0}}).has_value());
    EXPECT_FALSE(project(view_of(camera_at(0, 0, 1e6)), Ecef{{bad, 0, 0}}).has_value());
  }
}

TEST(ParseCamera, ThreeToSixFields) {
  const Result<Camera> three = parse_camera("30,20,6000000");
  ASSERT_TRUE(three.ok());
  EXPECT_EQ(three->eye.lat, Angle::degrees(30));
  EXPECT_EQ(three->eye.lon, Angle::degrees(20));
  EXPECT_EQ(three->eye.height_m, 6e6);
  EXPECT_EQ(three->heading, Angle::degrees(0));
  EXPECT_EQ(three->pitch, Angle::degrees(-90));
  EXPECT_EQ(three->fov_y, Angle::degrees(40));
  const Result<Camera> six = parse_camera("-46.5, 187, -3e5, 30, -20, 45");
  ASSERT_TRUE(six.ok());
  EXPECT_EQ(six->eye.lat, Angle::degrees(-46.5));
  EXPECT_EQ(six->eye.lon, Angle::degrees(187));
  EXPECT_EQ(six->heading, Angle::degrees(30));
  EXPECT_EQ(six->pitch, Angle::degrees(-20));
  EXPECT_EQ(six->fov_y, Angle::degrees(45));
  for (const char* limit : {"90,0,1e12", "-90,0,-1e12", "0,0,0,0,90", "0,0,0,0,0,0.01", "0,0,0,0,0,170"}) {
    EXPECT_TRUE(parse_camera(limit).ok()) << limit;
  }
}

TEST(ParseCamera, TakesPlacesAsPeopleWriteThem) {
  const Result<Camera> camera = parse_camera("30N,20.5W,1000km");
  ASSERT_TRUE(camera.ok()) << camera.error().message;
  EXPECT_DOUBLE_EQ(camera->eye.lat.deg(), 30.0);
  EXPECT_DOUBLE_EQ(camera->eye.lon.deg(), -20.5);
  EXPECT_DOUBLE_EQ(camera->eye.height_m, 1e6);
}

struct PlaceText {
  const char* text;
  double lat_deg, lon_deg;
};

TEST(ReadPlace, TakesDegreesMinutesSecondsAndBothOrders) {
  for (const PlaceText& p : std::initializer_list<PlaceText>{
           {"47.4, 8.5", 47.4, 8.5},
           {"47.4 8.5", 47.4, 8.5},
           {" -33.9,-151.2 ", -33.9, -151.2},
           {"47°24′N 8°30′E", 47.4, 8.5},
           {"47°24'36\"N, 8°30'E", 47.41, 8.5},
           {"47° 24' N 8° 30' W", 47.4, -8.5},
           {"8.5E 47.4N", 47.4, 8.5},
           {"30N20E", 30.0, 20.0},
           {"10, 190", 10.0, -170.0},
       }) {
    const auto place = read_place(p.text);
    ASSERT_TRUE(place.has_value()) << p.text;
    EXPECT_NEAR(place->lat.deg(), p.lat_deg, 1e-9) << p.text;
    EXPECT_NEAR(place->lon.deg(), p.lon_deg, 1e-9) << p.text;
  }
  for (const char* text : {"", "Zurich", "47", "91, 8", "47N 8N", "New York", "1 2 3", "nan, 0", "inf 0", "Essen"}) {
    EXPECT_FALSE(read_place(text).has_value()) << text;
  }
}

struct Refusal {
  const char* text;
  const char* names;  ///< words that the message must contain
};

TEST(ParseCamera, RefusalsNameTheFieldAndItsRange) {
  for (const Refusal& r : std::initializer_list<Refusal>{
           {"", "LAT,LON,ALT"},
           {"1,2", "3 to 6 numbers"},
           {"1,2,3,4,5,6,7", "3 to 6 numbers"},
           {"nan,0,1", "LAT is \"nan\", but must be from -90 to 90"},
           {"90.0001,0,1", "LAT is \"90.0001\""},
           {"-91,0,1", "LAT"},
           {"0,inf,1", "LON is \"inf\", but must be from -1e6 to 1e6"},
           {"0,20N,1", "LON is \"20N\""},
           {"20E,0,1", "LAT is \"20E\""},
           {"0,20X,1", "LON is \"20X\""},
           {"0,0,1mm", "ALT is \"1mm\""},
           {"0,0,2e12", "ALT is \"2e12\", but must be from -1e12 to 1e12 metres"},
           {"0,0,", "ALT is \"\""},
           {"0,0,1e999", "ALT"},
           {"0,0,1,-nan", "HEADING"},
           {"0,0,1,0,-90.5", "PITCH is \"-90.5\", but must be from -90"},
           {"0,0,1,0,0,0", "FOV is \"0\", but must be from 0.01 to 170 degrees"},
           {"0,0,1,0,0,170.1", "FOV"},
           {"0;0;1", "3 to 6 numbers"},
           {"0x1,0,1", "LAT"},
       }) {
    const Result<Camera> camera = parse_camera(r.text);
    ASSERT_FALSE(camera.ok()) << r.text;
    EXPECT_NE(camera.error().message.find(r.names), std::string::npos) << camera.error().message;
  }
}

TEST(ParseCamera, AnyTextIsAnswered) {
  Draw draw(53);
  constexpr std::string_view letters = "0123456789.,,,-+eE naif\t\"x";
  for (int k = 0; k < 20000; ++k) {
    std::string text;
    for (int length = draw.whole(0, 40); length > 0; --length) {
      text += letters[draw.whole<std::size_t>(0, letters.size() - 1)];
    }
    const Result<Camera> camera = parse_camera(text);
    if (!camera) continue;
    EXPECT_LE(std::abs(camera->eye.lat.deg()), 90.0) << text;
    EXPECT_TRUE(std::isfinite(camera->eye.lon.rad()) && std::isfinite(camera->heading.rad())) << text;
  }
}

TEST(ParseCamera, TheTextOfANameableCameraIsThatCamera) {
  constexpr double kRounding_deg = 1.0e-12;  // some units in the last place of 360 degrees
  Draw draw(54);
  for (int k = 0; k < 20000; ++k) {
    const Camera any = camera_at(draw.between(-90, 90), draw.between(-180, 180), draw.between(1, 1e8),
                                 draw.between(-360, 360), draw.between(-90, 90));
    // Angles as a flight leaves them: no degrees of any double give them exactly.
    Camera flown = any;
    flown.eye.lon = Angle::radians(std::nextafter(any.eye.lon.rad(), 9.0));
    const Camera camera = nameable(flown);
    const auto read = parse_camera(camera_text(camera));
    ASSERT_TRUE(read) << camera_text(camera);
    EXPECT_EQ(*read, camera) << camera_text(camera);
    EXPECT_NEAR(camera.eye.lon.deg(), flown.eye.lon.deg(), kRounding_deg);
  }
}

}  // namespace
}  // namespace terrella
