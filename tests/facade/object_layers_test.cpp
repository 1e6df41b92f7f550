// Object layers over each other: their order, and how opaque they are.
#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <utility>

#include "tests/gl/gl_fixture.h"
#include "tests/scene/patch_test_support.h"

namespace terrella::test {
namespace {

constexpr Viewport kObjectsSeen{64, 64};
constexpr ObjectColor kRedObject{220, 20, 20}, kBlueObject{20, 20, 220};
// Alpha in eight bits and one blend.
constexpr int kOfALevel = 1;

class ObjectLayers : public GlTest {
 protected:
  void SetUp() override {
    GlTest::SetUp();
    auto globe = Globe::create(unlit_options());
    ASSERT_TRUE(globe);
    globe_ = *std::move(globe);
    globe_->set_camera(camera_at(0, 0, 3.0e6));
  }
  /// A disc over the middle, or an area around it.
  static ObjectScene disc(ObjectColor color) {
    return {.points = {{.place = {.lat = {}, .lon = {}, .height_m = 1.0e3}, .size_px = 30.0F, .color = color}}};
  }
  static ObjectScene area(ObjectColor color) {
    const auto corner = [](double lat, double lon) {
      return Geodetic{.lat = Angle::degrees(lat), .lon = Angle::degrees(lon)};
    };
    return {.polygons = {{.rings = {{corner(-5, -5), corner(-5, 5), corner(5, 5), corner(5, -5)}},
                          .fill = color,
                          .stroke = {0, 0, 0, 0}}}};
  }
  std::array<int, 3> middle() {
    settle(*globe_, kObjectsSeen);
    const auto c = picture().at(32, 32);
    return {c[0], c[1], c[2]};
  }
  static void expect_mix(const std::array<int, 3>& got, const std::array<int, 3>& over, const std::array<int, 3>& under,
                         double opacity) {
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(got[k], opacity * over[k] + (1.0 - opacity) * under[k], kOfALevel) << "channel " << k;
    }
  }
  std::unique_ptr<Globe> globe_;
};

TEST_F(ObjectLayers, TheLastLiesOverTheOthersUntilItIsMoved) {
  for (const auto make : {disc, area}) {
    const std::array red{220, 20, 20}, blue{20, 20, 220};
    const LayerId first = *globe_->add_objects(make(kRedObject)), second = *globe_->add_objects(make(kBlueObject));
    EXPECT_EQ(middle(), blue);
    ASSERT_TRUE(globe_->move(second, 0));
    EXPECT_EQ(globe_->objects(), (std::vector{second, first}));
    EXPECT_EQ(middle(), red);
    ASSERT_TRUE(globe_->move(second, 7));
    EXPECT_EQ(globe_->objects(), (std::vector{first, second}));
    EXPECT_EQ(middle(), blue);
    ASSERT_TRUE(globe_->remove(first));
    ASSERT_TRUE(globe_->remove(second));
  }
}

TEST_F(ObjectLayers, AFadedOneShowsWhatLiesUnderItByHowMuchItIsFaded) {
  const std::array ground = middle(), red{220, 20, 20}, blue{20, 20, 220};
  const LayerId layer = *globe_->add_objects(disc(kRedObject));
  ASSERT_TRUE(globe_->fade_objects(layer, 0.4));
  expect_mix(middle(), red, ground, 0.4);
  ASSERT_TRUE(globe_->set_objects(layer, area(kBlueObject)));
  expect_mix(middle(), blue, ground, 0.4);
  ASSERT_TRUE(globe_->fade_objects(layer, 0.0));
  EXPECT_EQ(middle(), ground);
  EXPECT_FALSE(globe_->pick({32.0, 32.0}, kObjectsSeen).object);
  ASSERT_TRUE(globe_->fade_objects(layer, 1.0));
  EXPECT_EQ(middle(), blue);
  EXPECT_FALSE(globe_->fade_objects(layer, 1.5));
  EXPECT_EQ(middle(), blue);
}

// Counted, not timed: beside 2,000 areas each cut that is done in vain is felt.
TEST_F(ObjectLayers, OnlyALayerWhoseSceneChangesIsCutAgain) {
  const auto cut = [this] { return draw(*globe_, kObjectsSeen).objects_cut; };
  const auto place = [](double lat) { return Geodetic{.lat = Angle::degrees(lat), .lon = {}, .height_m = 0.0}; };
  const ObjectScene lines{.lines = {{.places = {place(0), place(9)}}, {.places = {place(1), place(7)}}}};
  const LayerId areas = *globe_->add_objects(area(kRedObject));
  EXPECT_EQ(cut(), 1U);
  const LayerId ways = *globe_->add_objects(lines);
  EXPECT_EQ(cut(), 2U) << "the area is not cut again";
  const LayerId marker = *globe_->add_objects(disc(kBlueObject));
  ASSERT_TRUE(globe_->set_objects(marker, disc(kRedObject)));
  ASSERT_TRUE(globe_->fade_objects(areas, 0.5));
  EXPECT_EQ(cut(), 0U) << "fading one and changing what is never cut";
  ASSERT_TRUE(globe_->move(areas, 2));
  ASSERT_TRUE(globe_->fade_objects(areas, 0.25));
  ASSERT_TRUE(globe_->show_objects(ways, false));
  EXPECT_EQ(cut(), 0U);
  ASSERT_TRUE(globe_->show_objects(ways, true));
  ASSERT_TRUE(globe_->fade_objects(areas, 1.0));
  ASSERT_TRUE(globe_->remove(marker));
  EXPECT_EQ(cut(), 0U) << "what was hidden or faded comes back as it was";
  ASSERT_TRUE(globe_->set_objects(ways, lines));
  EXPECT_EQ(cut(), 2U) << "a scene that is new is cut";
}

// A layer that is added, faded or taken away leaves the others' pixels as they were.
TEST_F(ObjectLayers, WhatIsKeptIsDrawnAsIfItWereNew) {
  const LayerId first = *globe_->add_objects(area(kRedObject));
  const LayerId over = *globe_->add_objects(disc(kBlueObject));
  settle(*globe_, kObjectsSeen);
  const auto both = picture().rgba;
  ASSERT_TRUE(globe_->fade_objects(first, 0.5));
  ASSERT_TRUE(globe_->move(over, 0));
  settle(*globe_, kObjectsSeen);
  EXPECT_NE(picture().rgba, both);
  ASSERT_TRUE(globe_->move(over, 1));
  ASSERT_TRUE(globe_->fade_objects(first, 1.0));
  settle(*globe_, kObjectsSeen);
  EXPECT_EQ(picture().rgba, both);
  ASSERT_TRUE(globe_->set_objects(over, {}));
  EXPECT_EQ(middle(), (std::array{220, 20, 20})) << "an empty scene shows nothing";
}

}  // namespace
}  // namespace terrella::test
