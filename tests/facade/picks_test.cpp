// Picks and projections through the façade: of places, layers and objects.
#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "tests/facade/geodetic_at.h"
#include "tests/gl/gl_fixture.h"
#include "tests/scene/patch_test_support.h"

namespace terrella::test {
namespace {

constexpr Viewport kPicked{200, 120};
// A pixel of the projected place lies at most a tenth of a pixel from the pixel that was picked.
constexpr double kInverse_px = 0.1;

class Picks : public GlTest {
 protected:
  void SetUp() override {
    GlTest::SetUp();
    globe_ = make_globe({}, one_colour({.tile_px = 16, .max_level = 1}, {10, 20, 30}));
  }
  void TearDown() override {
    globe_.reset();
    GlTest::TearDown();
  }
  /// The object where a place is in the picture, if it is the one meant.
  [[nodiscard]] std::optional<PickedObject> object_at(const Geodetic& place) const {
    const auto pixel = terrella::project(globe_->view(kPicked), globe_->options().body.ellipsoid.to_ecef(place));
    return pixel ? globe_->pick(*pixel, kPicked).object : std::nullopt;
  }
  std::unique_ptr<Globe> globe_;
};

TEST_F(Picks, ProjectionsInvertThemEverywhere) {
  int on_globe = 0;
  for (const Camera& camera : {camera_at(0, 0, 1.0e7), camera_at(90, 0, 5.0e6), camera_at(-89, 10, 2.0e5, 50, -30),
                               camera_at(10, 180, 1.0e6), camera_at(-20, -179.99, 1.0e4, 200, -20)}) {
    globe_->set_camera(camera);
    for (double x = 0.5; x < kPicked.width_px; x += 7.0) {
      for (double y = 0.5; y < kPicked.height_px; y += 7.0) {
        const auto place = globe_->pick({x, y}, kPicked).place;
        if (!place) continue;
        const auto pixel = globe_->project(*place, kPicked);
        ASSERT_TRUE(pixel) << x << ' ' << y;
        EXPECT_LT(glm::length(*pixel - glm::dvec2(x, y)), kInverse_px);
        ++on_globe;
      }
    }
  }
  EXPECT_GT(on_globe, 1000);
  globe_->set_camera(camera_at(0, 0, 1.0e7));
  EXPECT_FALSE(globe_->project(at(0, 180), kPicked)) << "behind the globe";
  EXPECT_FALSE(globe_->project(at(0, 0, 2.0e7), kPicked)) << "behind the eye";
}

TEST_F(Picks, TheHighestLayerDrawnThere) {
  const LayerId below = globe_->imagery().front();
  TileGrid east{.tile_px = 16, .max_level = 1};
  east.bounds.west = Angle::degrees(0.0);
  const LayerId above = *globe_->add_imagery(one_colour(east, {1, 2, 3}));
  globe_->set_camera(camera_at(0, 0, 1.0e7));
  EXPECT_EQ(globe_->pick({80.0, 60.0}, kPicked).imagery, below);
  EXPECT_EQ(globe_->pick({120.0, 60.0}, kPicked).imagery, above);
  EXPECT_EQ(globe_->pick({1.0, 1.0}, kPicked).imagery, LayerId::none);
  EXPECT_TRUE(globe_->set_look(above, {.shown = false}));
  EXPECT_EQ(globe_->pick({120.0, 60.0}, kPicked).imagery, below);
}

TEST_F(Picks, EachKindOfObjectByLayerAndIndex) {
  globe_->set_camera(camera_at(0, 0, 1.0e7));
  ObjectScene scene;
  scene.points = {{.place = at(20, 0)}, {.place = at(-20, 0, 1.0e5), .radius_m = 3.0e5}};
  scene.lines = {{.places = {at(10, -30), at(10, 30)}}};
  scene.polygons = {{.rings = {{at(-10, -30), at(-10, -10), at(5, -10), at(5, -30)}}}};
  const LayerId first = *globe_->add_objects(scene);
  const LayerId second = *globe_->add_objects({.points = {{.place = at(0, 30)}}});
  const auto is = [&](const Geodetic& place, ObjectKind kind, std::size_t index) {
    const auto object = object_at(place);
    return object && object->kind == kind && object->index == index;
  };
  EXPECT_TRUE(is(at(20, 0), ObjectKind::point, 0));
  EXPECT_TRUE(is(at(-20, 1, 1.0e5), ObjectKind::point, 1));
  // The geodesic between two places of a parallel bends towards the pole.
  EXPECT_TRUE(is(at(11.5, 0), ObjectKind::line, 0));
  EXPECT_TRUE(is(at(-2, -20), ObjectKind::polygon, 0));
  EXPECT_TRUE(is(at(0, 30), ObjectKind::point, 0));
  EXPECT_FALSE(object_at(at(-2, 20)));
  const auto pixel = globe_->project(at(0, 30), kPicked);
  ASSERT_TRUE(pixel);
  EXPECT_EQ(globe_->pick(*pixel, kPicked).objects, second);
  EXPECT_TRUE(globe_->show_objects(second, false));
  EXPECT_EQ(globe_->pick(*pixel, kPicked).objects, LayerId::none);
  EXPECT_TRUE(globe_->remove(first));
  EXPECT_FALSE(object_at(at(20, 0)));
}

TEST_F(Picks, WhatTheGlobeHidesIsNotPicked) {
  globe_->set_camera(camera_at(0, 0, 1.0e7));
  ASSERT_TRUE(globe_->add_objects(
      {.points = {{.place = at(0, 180), .size_px = 30.0F}, {.place = at(0, 0, -5.0e5), .radius_m = 1.0e5}}}));
  EXPECT_FALSE(globe_->pick({100.0, 60.0}, kPicked).object);
  globe_->set_surface({.alpha = 0.5});
  const auto object = globe_->pick({100.0, 60.0}, kPicked).object;
  ASSERT_TRUE(object);
  EXPECT_EQ(object->index, 1U);
}

}  // namespace
}  // namespace terrella::test
