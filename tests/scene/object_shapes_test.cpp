#include "objects/object_shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
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
  EXPECT_EQ(fill_area(planet, earth().ellipsoid, 1000).fault, FillFault::too_many_triangles);
  const PolygonObject antipodal{.rings = {{at(0, 0), at(0, 180), at(50, 90)}}};
  EXPECT_EQ(cut({.polygons = {antipodal}}).missing_fills().size(), 1U);
}

std::vector<Geodetic> square(double west_deg, double south_deg, double side_deg) {
  const double east_deg = west_deg + side_deg, north_deg = south_deg + side_deg;
  return {at(south_deg, west_deg), at(south_deg, east_deg), at(north_deg, east_deg), at(north_deg, west_deg)};
}

PolygonObject equal_rings(int n) { return {.rings = std::vector(std::size_t(n), square(0.0, 0.0, 10.0))}; }

PolygonObject nested_rings(int n) {
  PolygonObject rings;
  for (int k = 1; k <= n; ++k) rings.rings.push_back(square(-5.0 * k / n, -5.0 * k / n, 10.0 * k / n));
  return rings;
}

/// Squares whose edges almost lie on each other.
PolygonObject near_equal_rings(int n) {
  PolygonObject rings;
  for (int k = 1; k <= n; ++k) rings.rings.push_back(square(-1e-6 * k, -1e-6 * k, 1.0 + 2e-6 * k));
  return rings;
}

/// Slanted strips whose edges almost lie on each other.
PolygonObject slanted(int n) {
  PolygonObject rings;
  for (int k = 0; k < n; ++k) {
    const double a = 2e-6 * k;
    rings.rings.push_back({at(0, a), at(1, 1 + a), at(1, 1 + a + 1e-6), at(0, a + 1e-6)});
  }
  return rings;
}

PolygonObject holes(int n) {
  PolygonObject area{.rings = {square(0.0, 0.0, 10.0)}};
  const int across = static_cast<int>(std::sqrt(n));
  for (int k = 0; k < across * across; ++k) {
    area.rings.push_back(square(0.05 + 9.8 * (k % across) / across, 0.05 + 9.8 * (k / across) / across, 5.0 / across));
  }
  return area;
}

/// A star of long edges, which all pass near its middle and cross each other.
PolygonObject star(int n) {
  std::vector<Geodetic> ring;
  const int corners = n | 1;
  for (int k = 0; k < corners; ++k) {
    const double turn = 2.0 * std::numbers::pi * k * (corners / 2) / corners;
    ring.push_back(at(0.5 * std::sin(turn), 0.5 * std::cos(turn)));
  }
  return {.rings = {ring}};
}

PolygonObject zigzag(int n) {
  std::vector<Geodetic> ring;
  for (int k = 0; k < n; ++k) ring.push_back(at(k % 2, double(k) / n));
  return {.rings = {ring}};
}

TEST(ObjectShapes, TheCostOfAFillGrowsWithItsLengthEvenIfRingsAreEqualOrCross) {
  // Four times as much takes 16 times the steps if the cost is a square. Twice the factor leaves room for n log n.
  constexpr double kTimes = 4.0, kMostGrowth = 2.0 * kTimes;
  for (PolygonObject (*shape)(int) : {equal_rings, nested_rings, holes, star, zigzag}) {
    const auto steps = [&shape](int n) {
      return double(fill_area(shape(n), earth().ellipsoid, kMostFillTriangles, 0).steps);
    };
    EXPECT_LE(steps(401), kMostGrowth * steps(101));
    EXPECT_GT(steps(401), 0.0);
  }
}

TEST(ObjectShapes, EdgesThatAlmostLieOnEachOtherAreSeparatedBySteps) {
  for (PolygonObject (*shape)(int) : {near_equal_rings, slanted}) {
    EXPECT_EQ(fill_area(shape(101), earth().ellipsoid, kMostFillTriangles).fault, FillFault::none);
  }
  const FillMesh few = fill_area(zigzag(1601), earth().ellipsoid, kMostFillTriangles);
  const FillMesh many = fill_area(zigzag(6401), earth().ellipsoid, kMostFillTriangles);
  EXPECT_LT(double(many.steps), 8.0 * double(few.steps)) << "four times as many edges";
}

TEST(ObjectShapes, EqualRingsCancelEachOther) {
  const FillMesh one = fill_area(equal_rings(1), earth().ellipsoid, kMostFillTriangles);
  EXPECT_DOUBLE_EQ(area_m2(fill_area(equal_rings(501), earth().ellipsoid, kMostFillTriangles)), area_m2(one));
  const FillMesh none = fill_area(equal_rings(500), earth().ellipsoid, kMostFillTriangles);
  EXPECT_TRUE(none.indices.empty());
  EXPECT_EQ(none.fault, FillFault::none);
  // Also if a ring begins elsewhere or goes the other way round.
  PolygonObject turned = equal_rings(2);
  std::rotate(turned.rings[1].begin(), turned.rings[1].begin() + 2, turned.rings[1].end());
  std::ranges::reverse(turned.rings[0]);
  EXPECT_TRUE(fill_area(turned, earth().ellipsoid, kMostFillTriangles).indices.empty());
}

TEST(ObjectShapes, AnAreaThatCrossesItselfIsFilledUpToALimit) {
  const FillMesh small = fill_area(star(101), earth().ellipsoid, kMostFillTriangles);
  EXPECT_EQ(small.fault, FillFault::none);
  EXPECT_FALSE(small.indices.empty());
  const FillMesh large = fill_area(star(2001), earth().ellipsoid, kMostFillTriangles);
  EXPECT_EQ(large.fault, FillFault::tangled);
  EXPECT_TRUE(large.indices.empty());
  // Areas of one layer share the spare steps, so many such areas do not take longer than one.
  ObjectScene scene{.polygons = {star(2001), star(101), equal_rings(1)}};
  for (PolygonObject& area : scene.polygons) area.through_surface = true;  // areas on the ground need no triangles
  const auto missing = cut(scene).missing_fills();
  ASSERT_EQ(missing.size(), 2U);
  EXPECT_EQ(missing[1].fault, FillFault::tangled);
}

TEST(ObjectBatches, WhatIsNotFiniteIsNoTrouble) {
  for (const double bad : {std::nan(""), HUGE_VAL}) {
    const std::vector<Geodetic> places{at(0, 0), at(bad, bad, bad), at(1, 1), at(0, bad)};
    const ObjectScene scene{
        .points = {{.place = places[1]}}, .lines = {{.places = places}}, .polygons = {{.rings = {places}}}};
    EXPECT_EQ(cut(scene).missing_fills().size(), 1U);
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
