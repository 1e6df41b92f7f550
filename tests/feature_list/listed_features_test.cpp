#include "apps/open_scene/listed_features.h"

#include <gtest/gtest.h>

#include <vector>

namespace terrella {
namespace {

constexpr double kRounding_deg = 1e-9;

Geodetic place(double lat_deg, double lon_deg) {
  return {.lat = Angle::degrees(lat_deg), .lon = Angle::degrees(lon_deg)};
}

ObjectIdentity named(std::uint64_t id) { return {.id = ObjectId{id}}; }

void expect_at(const ListedFeature& feature, double lat_deg, double lon_deg) {
  EXPECT_NEAR(feature.place.lat.deg(), lat_deg, kRounding_deg);
  EXPECT_NEAR(feature.place.lon.deg(), lon_deg, kRounding_deg);
}

TEST(ListedFeatures, AreSortedByIdAndAPointWins) {
  ObjectScene scene;
  scene.points = {{.place = place(1, 2), .of = named(7)}, {.place = place(3, 4), .of = named(2)}, {.of = {}}};
  scene.polygons = {{.rings = {{place(0, 0), place(0, 9), place(9, 9)}}, .of = named(7)}};
  scene.labels = {{.text = "two", .place = place(5, 6), .of = named(2)}, {.text = "one", .of = named(1)}};
  const auto list = listed_features(scene);
  ASSERT_EQ(list.size(), 3U) << "an object without an id cannot be chosen";
  EXPECT_EQ(list[0].of.id, ObjectId{1});
  EXPECT_EQ(list[0].kind, ObjectKind::label);
  EXPECT_EQ(list[1].of.id, ObjectId{2});
  expect_at(list[1], 3, 4);
  EXPECT_EQ(list[2].kind, ObjectKind::point);
  expect_at(list[2], 1, 2);
}

TEST(ListedFeatures, ALineHasItsMiddleAndTheLongestCounts) {
  ObjectScene scene;
  scene.lines = {{.places = {place(0, 0), place(0, 1)}, .of = named(1)},
                 {.places = {place(0, 170), place(0, 172), place(0, -170)}, .of = named(1)},
                 {.places = {place(50, 5)}, .of = named(2)}};
  const auto list = listed_features(scene);
  ASSERT_EQ(list.size(), 2U);
  expect_at(list[0], 0, 180);
  expect_at(list[1], 50, 5);
}

TEST(ListedFeatures, AnAreaHasAPlaceInsideBesideHolesAndAcrossTheDateLine) {
  ObjectScene scene;
  const std::vector<Geodetic> hook{place(0, 0),  place(0, 10),  place(2, 10), place(2, 2), place(8, 2),
                                   place(8, 10), place(10, 10), place(10, 0), place(0, 0)};
  const std::vector<Geodetic> wide{place(-4, 176), place(-4, -176), place(6, -176), place(6, 176)};
  const std::vector<Geodetic> hole{place(0, 179), place(0, -177), place(3, -177), place(3, 179)};
  const std::vector<Geodetic> round_the_pole{place(80, 0), place(80, 120), place(80, -120)};
  scene.polygons = {{.rings = {hook}, .of = named(1)},
                    {.rings = {wide, hole}, .of = named(2)},
                    {.rings = {round_the_pole}, .of = named(3)}};
  const auto list = listed_features(scene);
  ASSERT_EQ(list.size(), 3U);
  expect_at(list[0], 5, 1);
  expect_at(list[1], 1, 177.5);
  expect_at(list[2], 80, 0);
}

}  // namespace
}  // namespace terrella
