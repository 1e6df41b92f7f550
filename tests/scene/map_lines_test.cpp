// Lines of a map: on their places, at the horizon, the antimeridian and the poles, from far and near.
#include "objects/map_lines.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <random>

#include "geo/body.h"

namespace terrella {
namespace {

using glm::dvec2;

constexpr double kError_px = 0.5;

Geodetic at(double lat, double lon) { return {.lat = Angle::degrees(lat), .lon = Angle::degrees(lon)}; }

View looking_at(double lat, double lon, double height_m, double heading = 0.0, double pitch = -90.0) {
  const Camera camera{.eye = {.lat = Angle::degrees(lat), .lon = Angle::degrees(lon), .height_m = height_m},
                      .heading = Angle::degrees(heading),
                      .pitch = Angle::degrees(pitch)};
  return make_view(camera, earth().ellipsoid, {1024, 768});
}

MapLines map_of(std::vector<Geodetic> places) {
  return {{{.kind = MapLineKind::border, .places = std::move(places)}}, earth().ellipsoid};
}

std::vector<MapPiece> traced(const MapLines& map, const View& view) {
  return map.trace(view, Ground(earth().ellipsoid), kError_px);
}

double distance_px(const std::vector<MapPiece>& pieces, dvec2 px) {
  double least = HUGE_VAL;
  for (const MapPiece& piece : pieces) {
    for (std::size_t k = 1; k < piece.points_px.size(); ++k) {
      const dvec2 a = piece.points_px[k - 1], way = piece.points_px[k] - a;
      const double part = std::clamp(glm::dot(px - a, way) / std::max(glm::dot(way, way), 1e-12), 0.0, 1.0);
      least = std::min(least, glm::distance(px, a + part * way));
    }
  }
  return least;
}

// A border along a parallel has two places, and bends in the picture.
TEST(MapLines, ABorderFollowsItsParallel) {
  const MapLines map = map_of({at(49.0, -123.0), at(49.0, -95.0)});
  for (const View& view : {looking_at(47.0, -109.0, 1.0e6), looking_at(42.0, -109.0, 1.0e6, 0.0, -60.0)}) {
    const auto pieces = traced(map, view);
    ASSERT_EQ(pieces.size(), 1U);
    EXPECT_EQ(pieces.front().kind, MapLineKind::border);
    int seen = 0;
    for (double lon = -122.9; lon < -95.0; lon += 0.1) {
      const auto px = project(view, earth().ellipsoid.to_ecef(at(49.0, lon)));
      if (!px || px->x < 0.0 || px->x > 1024.0 || px->y < 0.0 || px->y > 768.0) continue;
      ++seen;
      EXPECT_LT(distance_px(pieces, *px), kError_px) << lon;
    }
    EXPECT_GT(seen, 50);
  }
}

TEST(MapLines, NothingBehindTheHorizonIsDrawn) {
  EXPECT_TRUE(traced(map_of({at(-10.0, 170.0), at(10.0, 190.0)}), looking_at(0.0, 0.0, 1.0e7)).empty());
  const View view = looking_at(0.0, 0.0, 1.0e7);
  const auto pieces = traced(map_of({at(0.0, 0.0), at(0.0, 90.0), at(0.0, 179.0)}), view);
  ASSERT_EQ(pieces.size(), 1U);
  // The horizon is where cos(angle) = radius / distance of the eye.
  const double angle = std::acos(earth().ellipsoid.a_m() / (earth().ellipsoid.a_m() + 1.0e7));
  const auto limb = project(view, earth().ellipsoid.to_ecef(at(0.0, Angle::radians(angle).deg())));
  EXPECT_NEAR(pieces.front().points_px.back().x, limb->x, 0.5);
}

TEST(MapLines, ALineGoesTheShortWayAcrossTheAntimeridian) {
  const View view = looking_at(0.0, 180.0, 2.0e6);
  const auto pieces = traced(map_of({at(1.0, 179.0), at(1.0, -179.0)}), view);
  ASSERT_EQ(pieces.size(), 1U);
  const auto middle = project(view, earth().ellipsoid.to_ecef(at(1.0, 180.0)));
  EXPECT_LT(distance_px(pieces, *middle), kError_px);
  EXPECT_LT(glm::distance(pieces.front().points_px.front(), pieces.front().points_px.back()), 300.0);
}

TEST(MapLines, ALineCrossesAPole) {
  const View view = looking_at(90.0, 0.0, 2.0e6);
  const auto pieces = traced(map_of({at(85.0, 20.0), at(90.0, 20.0), at(90.0, -160.0), at(85.0, -160.0)}), view);
  ASSERT_FALSE(pieces.empty());
  EXPECT_LT(distance_px(pieces, {512.0, 384.0}), 0.1);
  for (const MapPiece& piece : pieces) {
    for (const dvec2 px : piece.points_px) EXPECT_TRUE(std::isfinite(px.x) && std::isfinite(px.y));
  }
}

// A ragged coast of 4,000 places.
std::vector<Geodetic> ragged_coast() {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> step(-0.02, 0.02);
  std::vector<Geodetic> coast;
  double lat = 0.0;
  for (int k = 0; k < 4000; ++k) coast.push_back(at(lat += step(random), -20.0 + 0.01 * k));
  return coast;
}

TEST(MapLines, AFarLineHasFewPlacesAndStaysWithinHalfAPixel) {
  const auto coast = ragged_coast();
  const MapLines map = map_of(coast);
  const View far = looking_at(0.0, 0.0, 1.2e7);
  const auto pieces = traced(map, far);
  std::size_t points = 0;
  for (const MapPiece& piece : pieces) points += piece.points_px.size();
  EXPECT_LT(points, coast.size() / 8);
  for (const Geodetic& place : coast) {
    ASSERT_LT(distance_px(pieces, *project(far, earth().ellipsoid.to_ecef(place))), kError_px + 0.05);
  }
  const View near = looking_at(coast[2000].lat.deg(), coast[2000].lon.deg(), 3.0e4);
  EXPECT_LT(distance_px(traced(map, near), {512.0, 384.0}), kError_px);
}

TEST(MapLines, AnIslandSmallerThanAPixelIsLeftOut) {
  std::vector<Geodetic> island;
  for (int k = 0; k <= 12; ++k) island.push_back(at(0.02 * std::sin(k * 0.5236), 0.02 * std::cos(k * 0.5236)));
  island.back() = island.front();
  const MapLines map = map_of(island);
  EXPECT_TRUE(traced(map, looking_at(0.0, 0.0, 1.5e7)).empty());
  EXPECT_FALSE(traced(map, looking_at(0.0, 0.0, 3.0e5)).empty());
}

TEST(MapLines, NoneFromUnderTheGround) {
  EXPECT_TRUE(traced(map_of({at(-5.0, 0.0), at(5.0, 0.0)}), looking_at(0.0, 0.0, -5.0e5, 0.0, 90.0)).empty());
}

class Plateau : public GroundHeights {
 public:
  [[nodiscard]] double height_m(Angle, Angle) const override { return 5000.0; }
  [[nodiscard]] std::optional<double> intersect_m(const Ecef&, const EcefDir&, double) const override { return {}; }
};

TEST(MapLines, ALineLiesOnTheRelief) {
  const MapLines map = map_of({at(46.0, 6.0), at(46.0, 9.0)});
  const View view = looking_at(45.5, 7.5, 6.0e4, 0.0, -40.0);
  const auto pieces = map.trace(view, Ground(earth().ellipsoid, std::make_shared<Plateau>()), kError_px);
  Geodetic place = at(46.0, 7.5);
  const auto on_ellipsoid = project(view, earth().ellipsoid.to_ecef(place));
  place.height_m = 5000.0;
  const auto on_relief = project(view, earth().ellipsoid.to_ecef(place));
  EXPECT_LT(distance_px(pieces, *on_relief), kError_px);
  EXPECT_GT(distance_px(pieces, *on_ellipsoid), 10.0);
}

}  // namespace
}  // namespace terrella
