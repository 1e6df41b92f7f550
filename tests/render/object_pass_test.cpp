// Objects alone, judged pixel by pixel against where geometry says they are.
#include <gtest/gtest.h>

#include <GeographicLib/GeodesicExact.hpp>
#include <GeographicLib/GeodesicLineExact.hpp>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "geo/great_circle.h"
#include "object_canvas.h"

namespace terrella::test {
namespace {

constexpr ObjectColor kRed{255, 0, 0}, kBlue{0, 0, 255}, kGreen{0, 200, 0};
// A pixel is drawn if its centre is covered: what geometry says is met to this.
constexpr double kEdge_px = 1.0;

PointObject sphere(const Geodetic& place, double radius_m, ObjectColor color) {
  return {.place = place, .radius_m = radius_m, .color = color};
}

glm::dvec2 center_of(int x, int y) { return {x + 0.5, y + 0.5}; }

using ObjectPassTest = ObjectCanvas;

/// Distance at which a pixel's ray passes a sphere, in pixels; negative: the ray meets the sphere.
double off_sphere_px(const View& view, const Ellipsoid& ellipsoid, const PointObject& ball, glm::dvec2 pixel) {
  const glm::dvec3 to = ellipsoid.to_ecef(ball.place).xyz_m - view.eye.xyz_m;
  const glm::dvec3 ray = pixel_ray(view, pixel).xyz;
  const double along = glm::dot(to, ray);
  return (glm::length(to - along * ray) - ball.radius_m) * view.pixels_per_radian() / along;
}

TEST_F(ObjectPassTest, SphereCoversTheDiscThatItsRadiusSays) {
  const PointObject ball = sphere(at(47.0, 8.0, -50.0e3), 300.0e3, kRed);
  for (const DepthMode depth : {DepthMode::reversed, DepthMode::logarithmic, DepthMode::standard}) {
    use(depth, {200, 200});
    for (const Camera& camera : {over(47.0, 8.0, 2.0e6), over(40.0, 3.0, 3.0e6, -60.0, 20.0)}) {
      const ObjectPicture picture = draw({.points = {ball}}, camera);
      int covered = 0;
      for (int y = 0; y < 200; ++y) {
        for (int x = 0; x < 200; ++x) {
          const double off_px = off_sphere_px(view(camera), ellipsoid(), ball, center_of(x, y));
          if (off_px < -kEdge_px) {
            ASSERT_EQ(picture.at(x, y), kRed) << x << ',' << y << " off " << off_px;
          }
          if (off_px > kEdge_px) {
            ASSERT_EQ(picture.at(x, y).alpha, 0) << x << ',' << y << " off " << off_px;
          }
          covered += off_px < 0.0 ? 1 : 0;
        }
      }
      EXPECT_GT(covered, 500);
    }
  }
}

TEST_F(ObjectPassTest, SphereIsRoundInAnOffAxisPicture) {
  const PointObject ball = sphere(at(0.0, 0.0, 0.0), 400.0e3, kRed);
  View sheared = view(over(0.0, 0.0, 3.0e6));
  sheared.shear_x = 0.15;
  const ObjectPicture picture = draw({.points = {ball}}, sheared);
  for (int y = 0; y < 200; ++y) {
    for (int x = 0; x < 200; ++x) {
      const double off_px = off_sphere_px(sheared, ellipsoid(), ball, center_of(x, y));
      if (off_px < -kEdge_px) {
        ASSERT_EQ(picture.at(x, y), kRed) << x << ',' << y << " off " << off_px;
      }
      if (off_px > kEdge_px) {
        ASSERT_EQ(picture.at(x, y).alpha, 0) << x << ',' << y << " off " << off_px;
      }
    }
  }
}

TEST_F(ObjectPassTest, NearerSphereHidesTheFartherAndTheyCutEachOtherWhereTheyMeet) {
  for (const DepthMode depth : {DepthMode::reversed, DepthMode::logarithmic, DepthMode::standard}) {
    use(depth, {200, 200});
    const PointObject near_ball = sphere(at(0.0, 0.0, 400.0e3), 200.0e3, kRed);
    const PointObject far_ball = sphere(at(0.0, 0.0, -400.0e3), 500.0e3, kBlue);
    for (const bool near_first : {true, false}) {
      ObjectScene scene;
      scene.points = near_first ? std::vector{near_ball, far_ball} : std::vector{far_ball, near_ball};
      const ObjectPicture picture = draw(scene, over(0.0, 0.0, 4.0e6));
      EXPECT_EQ(picture.at(100, 100), kRed);
      EXPECT_EQ(picture.at(80, 100), kBlue);
    }
    // Two of one size side by side: they cut each other in the plane between them.
    const ObjectScene pair{
        .points = {sphere(at(0.0, -2.0, 1.0), 400.0e3, kRed), sphere(at(0.0, 2.0, 1.0), 400.0e3, kBlue)}};
    const ObjectPicture picture = draw(pair, over(0.0, 0.0, 3.0e6));
    for (int y = 90; y < 110; ++y) {
      for (int x = 90; x < 99; ++x) EXPECT_EQ(picture.at(x, y), kRed) << x << ',' << y;
      for (int x = 101; x < 110; ++x) EXPECT_EQ(picture.at(x, y), kBlue) << x << ',' << y;
    }
  }
}

TEST_F(ObjectPassTest, SphereFarOffNeverVanishesAndOneAroundTheEyeIsNotDrawn) {
  const ObjectPicture far_off = draw({.points = {sphere(at(0.0, 0.0, 10.0), 10.0, kRed)}}, over(0.0, 0.0, 1.0e8));
  EXPECT_GT(far_off.at(99, 99).alpha + far_off.at(100, 100).alpha, 60);
  const ObjectPicture inside = draw({.points = {sphere(at(0.0, 0.0, 1000.0), 500.0, kRed)}}, over(0.0, 0.0, 1200.0));
  for (int k = 0; k < 200; ++k) ASSERT_EQ(inside.at(k, k).alpha, 0);
  // One that the eye all but touches fills the picture, though its triangle reaches behind the eye.
  const ObjectPicture touching = draw({.points = {sphere(at(0.0, 0.0, 1000.0), 500.0, kRed)}}, over(0.0, 0.0, 1501.0));
  for (int k = 0; k < 200; ++k) ASSERT_EQ(touching.at(k, 199 - k), kRed);
}

TEST_F(ObjectPassTest, HundredThousandSpheresAreADrawOfPointsAndOneOfTriangles) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> lat(-80.0, 80.0), lon(-180.0, 180.0), height(-700.0e3, -1.0);
  ObjectScene scene;
  for (int k = 0; k < 100'000; ++k)
    scene.points.push_back(sphere(at(lat(random), lon(random), height(random)), 5.0e3, kRed));
  const ObjectPicture first = draw(scene, over(10.0, 20.0, 1.0e7));
  EXPECT_LE(draw_calls_, 2);
  EXPECT_EQ(draw(scene, over(10.0, 20.0, 1.0e7)).rgba, first.rgba) << "the same scene gives other pixels";
}

/// Part of a pixel that a sphere covers, by rays through 16 by 16 places in it.
double covered_part(const View& view, const glm::dvec3& center_m, double radius_m, int x, int y) {
  constexpr int kSteps = 16;
  int hits = 0;
  for (int k = 0; k < kSteps * kSteps; ++k) {
    const glm::dvec2 within((k % kSteps + 0.5) / kSteps, (double(k / kSteps) + 0.5) / kSteps);
    const glm::dvec3 ray = pixel_ray(view, glm::dvec2(x, y) + within).xyz;
    const glm::dvec3 to = center_m - view.eye.xyz_m;
    hits += glm::length(to - glm::dot(to, ray) * ray) < radius_m ? 1 : 0;
  }
  return double(hits) / (kSteps * kSteps);
}

// Those up to 4 pixels are points, wider ones triangles; towards the corners their outlines are ellipses.
TEST_F(ObjectPassTest, SmallSpheresCoverOfEachPixelWhatGeometrySays) {
  constexpr double kOfAPixel = 0.2;  // coverage is linear across the edge, and towards the corners softer than a pixel
  constexpr double kOfTheWhole = 0.11;  // and so a disc is larger by a twelfth of a square pixel, times pi
  std::mt19937 random(11);
  std::uniform_real_distribution<double> part(-0.85, 0.85), radius_px(1.0, 6.0);
  Camera camera = over(10.0, 12.0, 1.0e7);
  camera.fov_y = Angle::degrees(75.0);
  use(DepthMode::reversed, {200, 200});
  for (const double shear : {0.0, 0.1}) {
    View eye = view(camera);
    eye.shear_x = shear;
    for (int turn = 0; turn < 40; ++turn) {
      const glm::dvec2 pixel = 100.0 + 100.0 * glm::dvec2(part(random), part(random));
      const glm::dvec3 center_m = eye.eye.xyz_m + 6.0e6 * pixel_ray(eye, pixel).xyz;
      const double radius_m = 6.0e6 * radius_px(random) / eye.pixels_per_radian();
      const Geodetic place = ellipsoid().to_geodetic(Ecef{center_m});
      const ObjectPicture picture = draw({.points = {sphere(place, radius_m, kRed)}}, eye);
      double seen = 0.0, said = 0.0;
      for (int y = 0; y < 200; ++y) {
        for (int x = 0; x < 200; ++x) {
          if (glm::distance(center_of(x, y), pixel) > 20.0) {
            ASSERT_EQ(picture.at(x, y).alpha, 0) << x << ',' << y;
            continue;
          }
          const double is = picture.at(x, y).alpha / 255.0, ought = covered_part(eye, center_m, radius_m, x, y);
          ASSERT_NEAR(is, ought, kOfAPixel) << x << ',' << y << " of one at " << pixel.x << ',' << pixel.y;
          seen += is;
          said += ought;
        }
      }
      EXPECT_NEAR(seen / said, 1.0, kOfTheWhole);
    }
  }
}

TEST_F(ObjectPassTest, OfSmallSpheresTheNearerHidesTheFarther) {
  for (const DepthMode depth : {DepthMode::reversed, DepthMode::logarithmic, DepthMode::standard}) {
    use(depth, {200, 200});
    const PointObject near_ball = sphere(at(0.0, 0.0, 300.0e3), 40.0e3, kRed);
    const PointObject far_ball = sphere(at(0.0, 0.0, 100.0e3), 70.0e3, kBlue);
    for (const bool near_first : {true, false}) {
      const ObjectScene scene{.points =
                                  near_first ? std::vector{near_ball, far_ball} : std::vector{far_ball, near_ball}};
      const ObjectPicture picture = draw(scene, over(0.0, 0.0, 7.0e6));
      EXPECT_EQ(picture.at(100, 100), kRed) << near_first;
    }
  }
}

TEST_F(ObjectPassTest, WhatASphereHidesIsNotDrawnAndAllElseIs) {
  // Spheres all round, with and without the hiding sphere drawn as an object that hides them: the same picture.
  std::mt19937 random(3);
  std::uniform_real_distribution<double> lat(-90.0, 90.0), lon(-180.0, 180.0), height(-900.0e3, 300.0e3);
  ObjectScene scene;
  for (int k = 0; k < 3000; ++k) {
    scene.points.push_back(sphere(at(lat(random), lon(random), height(random)), 60.0e3, kRed));
  }
  const double hiding_m = ellipsoid().a_m() - 1.0e6;
  const auto ball = [&](double part) { return sphere(at(0.0, 0.0, -ellipsoid().a_m()), part * hiding_m, kBlue); };
  scene.points.insert(scene.points.begin(), ball(1.0));
  for (const Camera& camera : {over(30.0, 60.0, 2.0e7), over(-50.0, 10.0, 5.0e5, -30.0)}) {
    hiding_radius_m_ = 0.0;
    const ObjectPicture all = draw(scene, camera);
    hiding_radius_m_ = hiding_m;
    EXPECT_EQ(draw(scene, camera).rgba, all.rgba);
  }
  scene.points.erase(scene.points.begin());
  const auto covered = [](const ObjectPicture& picture) {
    int count = 0;
    for (std::size_t k = 3; k < picture.rgba.size(); k += 4) count += picture.rgba[k] > 127 ? 1 : 0;
    return count;
  };
  const int fewer = covered(draw(scene, over(30.0, 60.0, 2.0e7)));
  hiding_radius_m_ = 0.0;
  EXPECT_GT(covered(draw(scene, over(30.0, 60.0, 2.0e7))), fewer + 100) << "nothing was spared";
}

TEST_F(ObjectPassTest, MarkerKeepsItsSizeWhateverTheDistance) {
  const PointObject marker{.place = at(10.0, 20.0), .size_px = 24.0F, .color = kGreen};
  for (const double height_m : {10.0, 1.0e4, 1.0e7, 1.0e8}) {
    const ObjectPicture picture = draw({.points = {marker}}, over(10.0, 20.0, height_m));
    EXPECT_EQ(picture.at(100, 100), kGreen) << height_m;
    for (int y = 0; y < 200; ++y) {
      for (int x = 0; x < 200; ++x) {
        const double off_px = glm::length(center_of(x, y) - glm::dvec2(100.0, 100.0)) - 12.0;
        if (std::abs(off_px) > kEdge_px) {
          ASSERT_EQ(picture.shown(x, y), off_px < 0.0) << x << ',' << y << ' ' << height_m;
        }
      }
    }
  }
}

TEST_F(ObjectPassTest, LineFollowsTheGeodesicAtItsWidth) {
  const GeographicLib::GeodesicExact geodesics(ellipsoid().a_m(), ellipsoid().f());
  const Geodetic from = at(50.0, -60.0), to = at(52.0, 20.0);
  const ObjectScene scene{.lines = {{.places = {from, to}, .width_px = 5.0F, .color = kRed, .through_surface = true}}};
  for (const DepthMode depth : {DepthMode::reversed, DepthMode::logarithmic, DepthMode::standard}) {
    use(depth, {400, 400});
    const Camera camera = over(60.0, -20.0, 8.0e6);
    const ObjectPicture picture = draw(scene, camera);
    const auto way = geodesics.InverseLine(50.0, -60.0, 52.0, 20.0);
    for (int k = 1; k < 200; ++k) {
      const auto place_px = [&](double part) {
        double lat = 0.0, lon = 0.0;
        way.Position(way.Distance() * part, lat, lon);
        return project(view(camera), ellipsoid().to_ecef(at(lat, lon))).value();
      };
      const glm::dvec2 p = place_px(k / 200.0);
      const glm::dvec2 along = glm::normalize(place_px((k + 0.5) / 200.0) - p);
      const glm::dvec2 across(-along.y, along.x);
      for (const double off_px : {-1.5, 0.0, 1.5}) {
        const glm::dvec2 q = p + off_px * across;
        ASSERT_TRUE(picture.shown(int(q.x), int(q.y))) << k << " at " << off_px << " px";
      }
      for (const double off_px : {-4.5, 4.5}) {
        const glm::dvec2 q = p + off_px * across;
        ASSERT_FALSE(picture.shown(int(q.x), int(q.y))) << k << " at " << off_px << " px";
      }
    }
    EXPECT_EQ(draw_calls_, 1);
  }
}

TEST_F(ObjectPassTest, LineEndsAtItsEnds) {
  const ObjectScene scene{
      .lines = {{.places = {at(0.0, -1.0), at(0.0, 1.0)}, .width_px = 3.0F, .color = kRed, .through_surface = true}}};
  const Camera camera = over(0.0, 0.0, 1.0e6);
  const ObjectPicture picture = draw(scene, camera);
  const double west = project(view(camera), ellipsoid().to_ecef(at(0.0, -1.0))).value().x;
  const double east = project(view(camera), ellipsoid().to_ecef(at(0.0, 1.0))).value().x;
  for (int x = 0; x < 200; ++x) {
    const double center = x + 0.5;
    if (center > west + kEdge_px && center < east - kEdge_px) {
      EXPECT_TRUE(picture.shown(x, 100)) << x;
    }
    if (center < west - kEdge_px || center > east + kEdge_px) {
      EXPECT_EQ(picture.at(x, 100).alpha, 0) << x;
    }
  }
}

TEST_F(ObjectPassTest, LineThatPassesBehindTheEyeIsStillStraight) {
  // Level with the ground, looking north along a line that begins far behind the eye.
  const ObjectScene scene{
      .lines = {{.places = {at(-1.0, 0.0), at(1.0, 0.0)}, .width_px = 6.0F, .color = kRed, .through_surface = true}}};
  const ObjectPicture picture = draw(scene, over(0.0, 0.0, 1000.0, -10.0));
  for (int y = 110; y < 200; ++y) {
    EXPECT_TRUE(picture.shown(99, y) && picture.shown(100, y)) << y;
    EXPECT_FALSE(picture.shown(90, y) || picture.shown(109, y)) << y;
  }
}

/// True if an even-odd test on the map has the place inside; not asked nearer to an edge than a pixel.
bool inside_rings(const std::vector<MapRing>& rings, const Geodetic& p) {
  bool inside = false;
  for (const MapRing& ring : rings) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const MapPoint &a = ring[i], &b = ring[(i + 1) % ring.size()];
      if ((a.lat_deg > p.lat.deg()) == (b.lat_deg > p.lat.deg())) continue;
      const double lon = a.lon_deg + (p.lat.deg() - a.lat_deg) / (b.lat_deg - a.lat_deg) * (b.lon_deg - a.lon_deg);
      inside ^= p.lon.deg() < lon;
    }
  }
  return inside;
}

/// Expected pixel of an area: 1 inside, 0 outside, -1 if the places within a pixel of it do not agree.
std::vector<int> expected_fill(const View& view, const Ellipsoid& ellipsoid, const PolygonObject& polygon) {
  std::vector<MapRing> rings;
  for (const auto& ring : polygon.rings) {
    std::vector<MapPoint> positions;
    for (const Geodetic& p : ring) positions.push_back({p.lon.deg(), p.lat.deg()});
    const auto parts = rings_of(positions);
    EXPECT_TRUE(parts.ok());
    rings.insert(rings.end(), parts->begin(), parts->end());
  }
  const int w = view.viewport.width_px, h = view.viewport.height_px;
  std::vector<int> inside(static_cast<std::size_t>(w * h), -1), expected = inside;
  const auto index = [w](int x, int y) { return static_cast<std::size_t>(y * w + x); };
  for (int y = 0; y < h; ++y) {
    for (int x = 0; x < w; ++x) {
      const auto place = pick(view, ellipsoid, center_of(x, y));
      if (place) inside[index(x, y)] = inside_rings(rings, *place) ? 1 : 0;
    }
  }
  for (int y = 1; y + 1 < h; ++y) {
    for (int x = 1; x + 1 < w; ++x) {
      const int here = inside[index(x, y)];
      const bool agree = here == inside[index(x - 1, y)] && here == inside[index(x + 1, y)] &&
                         here == inside[index(x, y - 1)] && here == inside[index(x, y + 1)];
      if (agree) expected[index(x, y)] = here;
    }
  }
  return expected;
}

void expect_filled(const ObjectPicture& picture, const std::vector<int>& expected) {
  int count[2] = {};
  for (std::size_t k = 0; k < expected.size(); ++k) {
    if (expected[k] < 0) continue;
    ++count[expected[k]];
    ASSERT_EQ(picture.rgba[4 * k + 3], 255 * expected[k])
        << static_cast<int>(k) % picture.size.width_px << ',' << static_cast<int>(k) / picture.size.width_px;
  }
  EXPECT_GT(count[0], 200);
  EXPECT_GT(count[1], 200);
}

TEST_F(ObjectPassTest, AreasAreFilledOverThePoleAndOverTheAntimeridian) {
  const auto ring = [](std::initializer_list<std::pair<double, double>> lon_lat) {
    std::vector<Geodetic> places;
    for (const auto& [lon, lat] : lon_lat) places.push_back(at(lat, lon));
    return places;
  };
  struct Case {
    const char* name;
    std::vector<std::vector<Geodetic>> rings;
    Camera camera;
  };
  const Case cases[] = {
      {"over a pole", {ring({{0, 70}, {100, 65}, {-120, 72}})}, over(80.0, 30.0, 6.0e6)},
      {"over a pole with a hole at it",
       {ring({{0, 60}, {90, 60}, {180, 60}, {-90, 60}}), ring({{0, 80}, {120, 80}, {-120, 80}})},
       over(90.0, 0.0, 6.0e6)},
      {"over the antimeridian", {ring({{160, -20}, {-160, -25}, {-150, 10}, {175, 20}})}, over(0.0, 180.0, 8.0e6)},
      {"around the south pole as maps draw it",
       {ring({{-180, -90}, {-180, -70}, {-60, -75}, {60, -65}, {180, -70}, {180, -90}})},
       over(-85.0, 100.0, 6.0e6)},
      {"small, with a hole",
       {ring({{8, 47}, {9, 47}, {9, 48}, {8, 48}}), ring({{8.3, 47.3}, {8.7, 47.4}, {8.5, 47.8}})},
       over(47.5, 8.5, 2.0e5)},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.name);
    const PolygonObject polygon{.rings = c.rings, .fill = kGreen, .stroke = {0, 0, 0, 0}, .through_surface = true};
    use(DepthMode::reversed, {80, 80});
    const std::vector<int> expected = expected_fill(view(c.camera), ellipsoid(), polygon);
    for (const DepthMode depth : {DepthMode::reversed, DepthMode::logarithmic, DepthMode::standard}) {
      use(depth, {80, 80});
      expect_filled(draw({.polygons = {polygon}}, c.camera), expected);
    }
  }
}

TEST_F(ObjectPassTest, NothingJittersFromAMetreAway) {
  // The eye moves by a thousandth of a pixel: the picture must not.
  const PointObject ball = sphere(at(47.123, 8.456, 0.5), 0.2, kRed);
  for (int k = 0; k < 20; ++k) {
    Camera camera = over(47.123, 8.456, 2.0);
    camera.eye.lon = camera.eye.lon + Angle::radians(k * 1.0e-5 / ellipsoid().a_m());
    const ObjectPicture picture = draw({.points = {ball}}, camera);
    for (int y = 0; y < 200; ++y) {
      for (int x = 0; x < 200; ++x) {
        const double off_px = off_sphere_px(view(camera), ellipsoid(), ball, center_of(x, y));
        if (std::abs(off_px) > kEdge_px) {
          ASSERT_EQ(picture.shown(x, y), off_px < 0.0) << x << ',' << y << " step " << k;
        }
      }
    }
  }
}

TEST_F(ObjectPassTest, TranslucentObjectsBlendWithWhatLiesBehind) {
  const ObjectScene scene{.points = {sphere(at(0.0, 0.0, -400.0e3), 500.0e3, kBlue),
                                     sphere(at(0.0, 0.0, 400.0e3), 200.0e3, {255, 0, 0, 128})}};
  const ObjectColor seen = draw(scene, over(0.0, 0.0, 4.0e6)).at(100, 100);
  EXPECT_NEAR(seen.red, 128, 1);
  EXPECT_NEAR(seen.blue, 127, 1);
  EXPECT_EQ(draw_calls_, 2);
}

TEST_F(ObjectPassTest, TranslucentAreasLieOverEachOtherByHeightWhateverTheirOrder) {
  const auto area = [](double west, double height_m, ObjectColor fill) {
    PolygonObject polygon{.fill = fill, .stroke = {0, 0, 0, 0}};
    polygon.rings = {{at(-2.0, west, height_m), at(-2.0, west + 4.0, height_m), at(2.0, west + 4.0, height_m),
                      at(2.0, west, height_m)}};
    return polygon;
  };
  const PolygonObject low = area(-3.0, 1.0e3, {255, 0, 0, 128}), high = area(-1.0, 50.0e3, {0, 0, 255, 128});
  for (const Camera& camera : {over(0.0, 0.0, 1.0e6), over(-6.0, 0.0, 8.0e5, -45.0)}) {
    const ObjectPicture first = draw({.polygons = {low, high}}, camera);
    EXPECT_EQ(draw({.polygons = {high, low}}, camera).rgba, first.rgba);
  }
  const ObjectColor both = draw({.polygons = {high, low}}, over(0.0, 0.0, 1.0e6)).at(100, 100);
  EXPECT_NEAR(both.blue, 128, 2) << "half of the nearer one";
  EXPECT_NEAR(both.red, 64, 2) << "and half of the other behind it";
}

}  // namespace
}  // namespace terrella::test
