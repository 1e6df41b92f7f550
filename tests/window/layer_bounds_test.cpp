#include <gtest/gtest.h>

#include "apps/open_scene/bounds_view.h"

namespace terrella {
namespace {

ObjectScene points_at(std::initializer_list<glm::dvec2> lats_lons_deg) {
  ObjectScene scene;
  for (const glm::dvec2 at : lats_lons_deg) {
    scene.points.push_back({.place = {.lat = Angle::degrees(at.x), .lon = Angle::degrees(at.y)}});
  }
  return scene;
}

constexpr double kSame_deg = 1e-9;  // tolerance of numbers that are passed on

TEST(LayerBounds, HoldAllPlaces) {
  const auto bounds = bounds_of(points_at({{10, 20}, {-5, 40}, {30, 25}}));
  ASSERT_TRUE(bounds);
  EXPECT_NEAR(bounds->west.deg(), 20.0, kSame_deg);
  EXPECT_NEAR(bounds->east.deg(), 40.0, kSame_deg);
  EXPECT_NEAR(bounds->south.deg(), -5.0, kSame_deg);
  EXPECT_NEAR(bounds->north.deg(), 30.0, kSame_deg);
}

TEST(LayerBounds, CrossTheAntimeridianWhereThatIsShorter) {
  const auto bounds = bounds_of(points_at({{0, 170}, {1, -175}, {2, 179}}));
  ASSERT_TRUE(bounds);
  EXPECT_NEAR(bounds->west.deg(), 170.0, kSame_deg);
  EXPECT_NEAR(bounds->east.deg(), -175.0, kSame_deg);
  EXPECT_NEAR(width_of(*bounds).deg(), 15.0, kSame_deg);
}

TEST(LayerBounds, AreNothingForNothingAndForThePlanet) {
  EXPECT_FALSE(bounds_of({}));
  EXPECT_FALSE(if_a_part(GeoRect{}));
  const ObjectScene around = points_at({{0, -180}, {0, -135}, {0, -90}, {0, -45}, {0, 0}, {0, 45}, {0, 90}, {0, 135}});
  EXPECT_FALSE(bounds_of(around));
}

TEST(LayerBounds, OfOnePointAreThatPoint) {
  const auto bounds = bounds_of(points_at({{45, 7}}));
  ASSERT_TRUE(bounds);
  EXPECT_NEAR(width_of(*bounds).deg(), 0.0, kSame_deg);
}

}  // namespace
}  // namespace terrella
