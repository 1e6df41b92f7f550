// Groups of points for clusters, against distances in the picture.
#include "objects/cluster/point_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "geo/body.h"

namespace terrella {
namespace {

constexpr Viewport kPicture{800, 600};
constexpr double kRadius_px = 40.0;

Geodetic at(double lat_deg, double lon_deg) { return {.lat = Angle::degrees(lat_deg), .lon = Angle::degrees(lon_deg)}; }

View view_of(const Geodetic& place, double height_m) {
  return make_view({.eye = {.lat = place.lat, .lon = place.lon, .height_m = height_m}}, earth().ellipsoid, kPicture);
}

glm::dvec2 pixel_of(const View& view, const EcefDir& normal) {
  return project(view, earth().ellipsoid.position(normal)).value_or(glm::dvec2(-1e9));
}

std::vector<Geodetic> scattered(std::size_t count, const Geodetic& middle, double reach_deg) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> aside(-reach_deg, reach_deg);
  std::vector<Geodetic> places;
  for (std::size_t i = 0; i < count; ++i) {
    places.push_back(at(middle.lat.deg() + aside(random), middle.lon.deg() + aside(random)));
  }
  return places;
}

TEST(PointTree, EachPointIsInOneNodeNearIt) {
  const std::vector<Geodetic> places = scattered(3000, at(10, 20), 3.0);
  const PointTree tree(places);
  for (const double height_m : {4.0e5, 1.0e6, 1.0e7}) {
    const View view = view_of(at(10, 20), height_m);
    std::vector<int> times(places.size());
    for (const std::uint32_t node : tree.cut(view, earth().ellipsoid, kRadius_px)) {
      const glm::dvec2 middle_px = pixel_of(view, {tree.nodes()[node].normal});
      const std::vector<std::uint32_t> points = tree.points_of(node);
      EXPECT_EQ(points.size(), tree.nodes()[node].count);
      for (const std::uint32_t point : points) {
        ++times[point];
        // A group is twice the radius wide at most, and its parts half of it, a quarter, …
        const glm::dvec2 pixel = pixel_of(view, Ellipsoid::normal(places[point].lat, places[point].lon));
        EXPECT_LE(glm::distance(pixel, middle_px), 4.0 * kRadius_px);
      }
    }
    for (std::size_t i = 0; i < places.size(); ++i) {
      const glm::dvec2 pixel = pixel_of(view, Ellipsoid::normal(places[i].lat, places[i].lon));
      const bool inside = pixel.x > 0.0 && pixel.y > 0.0 && pixel.x < kPicture.width_px && pixel.y < kPicture.height_px;
      EXPECT_LE(times[i], 1);
      EXPECT_GE(times[i], inside ? 1 : 0) << height_m;
    }
  }
}

TEST(PointTree, NodesAreARadiusApart) {
  const PointTree tree(scattered(20'000, at(-30, 100), 5.0));
  const View view = view_of(at(-30, 100), 1.2e6);
  std::vector<glm::dvec2> pixels;
  for (const std::uint32_t node : tree.cut(view, earth().ellipsoid, kRadius_px)) {
    pixels.push_back(pixel_of(view, {tree.nodes()[node].normal}));
  }
  ASSERT_GT(pixels.size(), 40U);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      // The ground at the edge of the picture is farther away than its middle, and seen at a slant: 5 degrees of it.
      EXPECT_GE(glm::distance(pixels[i], pixels[k]), 0.9 * kRadius_px);
    }
  }
}

TEST(PointTree, PolesAndTheAntimeridianAreNoBorders) {
  for (const bool pole : {true, false}) {
    std::vector<Geodetic> places;
    for (int i = 0; i < 8; ++i)
      places.push_back(pole ? at(89.99, 45.0 * i) : at(0.01 * i, i % 2 == 0 ? 179.99 : -179.99));
    const PointTree tree(places);
    const auto shown = tree.cut(view_of(pole ? at(90, 0) : at(0, 180), 1.0e6), earth().ellipsoid, kRadius_px);
    ASSERT_EQ(shown.size(), 1U);
    EXPECT_EQ(tree.nodes()[shown[0]].count, 8U);
    EXPECT_EQ(tree.cut(view_of(places[3], 500.0), earth().ellipsoid, kRadius_px), std::vector<std::uint32_t>{3});
  }
}

TEST(PointTree, PointsAtOnePlaceStayTogether) {
  const PointTree tree(std::vector<Geodetic>(50, at(47, 11)));
  const auto shown = tree.cut(view_of(at(47, 11), 2.0), earth().ellipsoid, kRadius_px);
  ASSERT_EQ(shown.size(), 1U);
  EXPECT_EQ(tree.nodes()[shown[0]].count, 50U);
  EXPECT_TRUE(PointTree({}).cut(view_of(at(0, 0), 1e7), earth().ellipsoid, kRadius_px).empty());
}

}  // namespace
}  // namespace terrella
