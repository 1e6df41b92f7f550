#include "objects/object_shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "geo/body.h"
#include "objects/layer_objects.h"

namespace terrella {
namespace {

// GeographicLib's geodesics are good to nanometres, positions at the planet's size to one.
constexpr double kPlace_m = 1.0e-6;

Geodetic at(double lat_deg, double lon_deg, double height_m = 0.0) {
  return {.lat = Angle::degrees(lat_deg), .lon = Angle::degrees(lon_deg), .height_m = height_m};
}

LayerObjects cut(const ObjectScene& scene) {
  LayerObjects objects(scene, earth().ellipsoid, 1.0, kSelectedColor);
  objects.place(cut_objects(objects.take_job(), false));
  return objects;
}

TEST(ObjectShapes, PiecesOfALineStayWithinTheirSagOfTheSurface) {
  for (const Ellipsoid& ellipsoid : {earth().ellipsoid, Ellipsoid(60.268e6, 0.098)}) {
    const auto line = line_along_geodesics({at(-30.0, 10.0), at(60.0, 170.0)}, ellipsoid, kLineStep);
    const double sag = sag_m(ellipsoid, kLineStep);
    ASSERT_GT(line.size(), 1000U);
    for (std::size_t k = 1; k < line.size(); ++k) {
      const double middle_m = ellipsoid.to_geodetic(Ecef{0.5 * (line[k - 1] + line[k])}).height_m;
      ASSERT_GE(middle_m, -kPlace_m) << k;
      ASSERT_LE(middle_m, sag + kPlace_m) << k;
    }
  }
  EXPECT_LT(sag_m(earth().ellipsoid, kLineStep), 0.5);
}

TEST(ObjectShapes, ALineUnderTheGroundKeepsItsDepthsAndEnds) {
  const auto line = line_along_geodesics({at(0.0, 0.0, -1000.0), at(0.0, 1.0, -3000.0)}, earth().ellipsoid, kLineStep);
  const Geodetic middle = earth().ellipsoid.to_geodetic(Ecef{line[line.size() / 2]});
  const double part = double(line.size() / 2) / double(line.size() - 1);
  EXPECT_NEAR(middle.height_m, -1000.0 - 2000.0 * part, kPlace_m);
  EXPECT_LT(glm::distance(line.front(), earth().ellipsoid.to_ecef(at(0.0, 0.0, -1000.0)).xyz_m), kPlace_m);
  EXPECT_LT(glm::distance(line.back(), earth().ellipsoid.to_ecef(at(0.0, 1.0, -3000.0)).xyz_m), kPlace_m);
}

double area_m2(const FillMesh& mesh) {
  double sum = 0.0;
  for (std::size_t k = 0; k + 2 < mesh.indices.size(); k += 3) {
    const glm::dvec3 &a = mesh.positions_m[mesh.indices[k]], &b = mesh.positions_m[mesh.indices[k + 1]],
                     &c = mesh.positions_m[mesh.indices[k + 2]];
    sum += 0.5 * glm::length(glm::cross(b - a, c - a));
  }
  return sum;
}

TEST(ObjectShapes, AnAreaHasItsArea) {
  // On a sphere what a box of the whole planet and an octant cover is known; flat triangles fall short a little.
  constexpr double kFlat = 1.0e-3, kRadius_m = 1.0e6;
  const Ellipsoid sphere(kRadius_m, 0.0);
  const double whole = 4.0 * std::numbers::pi * kRadius_m * kRadius_m;
  const PolygonObject planet{.rings = {{at(-90, -180), at(-90, 180), at(90, 180), at(90, -180)}}};
  EXPECT_NEAR(area_m2(fill_area(planet, sphere, kMostFillTriangles)) / whole, 1.0, kFlat);
  const PolygonObject octant{.rings = {{at(0, 140), at(0, -130), at(90, 0)}}};
  EXPECT_NEAR(area_m2(fill_area(octant, sphere, kMostFillTriangles)) / whole, 0.125, kFlat);
  // A ring that crosses itself is filled even-odd: two of four petals.
  const PolygonObject bow{.rings = {{at(0, 0), at(1, 1), at(0, 1), at(1, 0)}}};
  const PolygonObject box{.rings = {{at(0, 0), at(0, 1), at(1, 1), at(1, 0)}}};
  EXPECT_NEAR(area_m2(fill_area(bow, sphere, 1000000)) / area_m2(fill_area(box, sphere, 1000000)), 0.5, kFlat);
}

TEST(ObjectShapes, AnAreaThatTakesTooMuchIsLeftOutAndCounted) {
  const PolygonObject planet{.rings = {{at(-90, -180), at(-90, 180), at(90, 180), at(90, -180)}}};
  EXPECT_TRUE(fill_area(planet, earth().ellipsoid, 1000).indices.empty());
  const PolygonObject antipodal{.rings = {{at(0, 0), at(0, 180), at(50, 90)}}};
  EXPECT_EQ(cut({.polygons = {antipodal}}).fills_dropped(), 1U);
}

TEST(ObjectBatches, WhatIsNotFiniteIsNoTrouble) {
  for (const double bad : {std::nan(""), HUGE_VAL}) {
    const std::vector<Geodetic> places{at(0, 0), at(bad, bad, bad), at(1, 1), at(0, bad)};
    const ObjectScene scene{
        .points = {{.place = places[1]}}, .lines = {{.places = places}}, .polygons = {{.rings = {places}}}};
    EXPECT_EQ(cut(scene).fills_dropped(), 1U);
  }
}

TEST(ObjectBatches, PartOpacityAndChoiceLieTogether) {
  const PointObject over{.place = at(1, 1, 5), .radius_m = 1.0};
  PointObject under = over, clear = over, chosen = over;
  under.place.height_m = -5.0;
  clear.color.alpha = 100;
  chosen.through_surface = true;
  LayerObjects objects = cut({.points = {clear, chosen, under, over, chosen}});
  objects.tidy();
  const Batch<char>& spheres = objects.batches().spheres.ranges;
  EXPECT_EQ(spheres.range(ObjectPart::underground, true, ObjectChoice::all).count, 1U);
  EXPECT_EQ(spheres.range(ObjectPart::above_ground, true, ObjectChoice::all).count, 3U);
  EXPECT_EQ(spheres.range(ObjectPart::above_ground, true, ObjectChoice::chosen).count, 2U);
  EXPECT_EQ(spheres.range(ObjectPart::above_ground, true, ObjectChoice::others).count, 1U);
  EXPECT_EQ(spheres.range(ObjectPart::above_ground, false, ObjectChoice::all).count, 1U);
}

}  // namespace
}  // namespace terrella
