// Icons on a globe: what the ground hides, what edits change, and what is refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <utility>

#include "tests/gl/gl_fixture.h"
#include "tests/scene/patch_test_support.h"

namespace terrella::test {
namespace {

using testing::HasSubstr;

constexpr Viewport kIconsSeen{200, 200};

Geodetic icon_at(double lat_deg, double lon_deg, double height_m = 0.0) {
  return {.lat = Angle::degrees(lat_deg), .lon = Angle::degrees(lon_deg), .height_m = height_m};
}
std::shared_ptr<const IconImage> icon_image(int width_px, int height_px, Color color = {255, 0, 255}) {
  IconImage icon{width_px, height_px, {}};
  for (int k = 0; k < width_px * height_px; ++k) icon.rgba.insert(icon.rgba.end(), {color[0], color[1], color[2], 255});
  return std::make_shared<const IconImage>(std::move(icon));
}
PointObject icon(std::uint64_t id, const Geodetic& place) {
  static const auto shared = icon_image(8, 8);
  return {.place = place, .size_px = 16.0F, .icon = {.image = shared}, .of = {.id = ObjectId{id}}};
}

class Icons : public GlTest {
 protected:
  void SetUp() override {
    GlTest::SetUp();
    globe_ = make_globe(unlit_options(), one_colour({.tile_px = 16, .max_level = 1}, {0, 160, 0}));
    globe_->set_camera(camera_at(0, 0, 8.0e6));
  }
  void TearDown() override {
    globe_.reset();
    GlTest::TearDown();
  }
  /// Pixels of a colour.
  int count(Color color = {255, 0, 255}) {
    settle(*globe_, kIconsSeen);
    const Picture seen = picture();
    int found = 0;
    for (int y = 0; y < kIconsSeen.height_px; ++y) {
      for (int x = 0; x < kIconsSeen.width_px; ++x) found += seen.at(x, y) == color ? 1 : 0;
    }
    return found;
  }
  std::unique_ptr<Globe> globe_;
};

// The horizon is 73.4 degrees away from 16,000 km up.
TEST_F(Icons, OnesBehindTheGlobeAreHiddenAndOnesAtTheLimbAreWhole) {
  globe_->set_camera(camera_at(0, 0, 1.6e7));
  const LayerId layer = *globe_->add_objects({});
  for (const auto& [lon_deg, shown] :
       {std::pair{0.0, true}, {70.0, true}, {73.0, true}, {79.0, false}, {120.0, false}, {180.0, false}}) {
    ASSERT_TRUE(globe_->set_objects(layer, {.points = {icon(1, icon_at(0, lon_deg))}}));
    // A turned or shifted edge takes at most a row and a column.
    if (shown) {
      EXPECT_GE(count(), 14 * 14) << lon_deg;
    } else {
      EXPECT_EQ(count(), 0) << lon_deg;
    }
  }
}

TEST_F(Icons, EditsMoveTurnTintSelectHideAndRemoveThem) {
  const auto empty = count();
  EXPECT_EQ(empty, 0);
  const auto half = std::make_shared<const IconImage>(IconImage{1, 2, {255, 0, 255, 255, 0, 0, 255, 255}});
  PointObject point = icon(1, icon_at(0, 0));
  point.icon.image = half;
  point.size_px = 40.0F;
  const LayerId layer = *globe_->add_objects({.points = {point}});
  const auto middle = [this](int x, int y) { return settle(*globe_, kIconsSeen), picture().at(100 + x, 100 + y); };
  const Color magenta{255, 0, 255}, blue{0, 0, 255};
  EXPECT_EQ(middle(0, -15), magenta) << "the first row is at the top";
  EXPECT_EQ(middle(0, 15), blue);
  const auto edit = [&](ObjectEdits edits) { ASSERT_TRUE(globe_->edit_objects(layer, std::move(edits))); };
  edit({.moves = {{ObjectId{1}, icon_at(0, 0), Angle::degrees(180.0)}}});
  EXPECT_EQ(middle(0, -15), blue);
  edit({.changes = {{.id = ObjectId{1}, .color = ObjectColor{255, 255, 100}, .heading = Angle::degrees(90.0)}}});
  EXPECT_EQ(middle(-15, 0), (Color{0, 0, 100}));
  EXPECT_EQ(middle(15, 0), (Color{255, 0, 100}));
  edit({.changes = {{.id = ObjectId{1}, .selected = true}}, .selected_color = ObjectColor{0, 255, 0}});
  EXPECT_GT(middle(15, 0)[1], 140) << "most of the colour is the selection's";
  EXPECT_GT(middle(15, 0)[0], 90) << "some is the picture's";
  edit({.changes = {{.id = ObjectId{1}, .visible = false}}});
  EXPECT_EQ(middle(15, 0), (Color{0, 160, 0}));
  EXPECT_FALSE(globe_->pick({100, 100}, kIconsSeen).object);
  edit({.changes = {{.id = ObjectId{1}, .visible = true, .selected = false, .color = ObjectColor{255, 255, 255}}}});
  EXPECT_EQ(globe_->pick({118, 100}, kIconsSeen).object->of.id, ObjectId{1});
  EXPECT_FALSE(globe_->pick({100, 118}, kIconsSeen).object) << "it lies across";
  ASSERT_TRUE(globe_->fade_objects(layer, 0.5));
  EXPECT_NEAR(middle(15, 0)[0], 127, 2);
  EXPECT_NEAR(middle(15, 0)[1], 80, 2);
  ASSERT_TRUE(globe_->fade_objects(layer, 1.0));
  edit({.remove = {ObjectId{1}}});
  EXPECT_EQ(middle(15, 0), (Color{0, 160, 0}));
}

TEST_F(Icons, AMoveOfManyIsDrawnAsIfTheyWereNewAndCutsNothing) {
  ObjectScene scene;
  for (std::uint64_t k = 0; k < 50; ++k) {
    scene.points.push_back(icon(k + 1, icon_at(-20.0 + double(k % 7) * 6.0, -20.0 + double(k / 7) * 6.0)));
    scene.points.back().icon = {.image = k % 2 == 0 ? scene.points[0].icon.image : icon_image(4 + int(k), 9),
                                .from_north = true};
  }
  const LayerId layer = *globe_->add_objects(scene);
  settle(*globe_, kIconsSeen);
  ObjectEdits edits;
  for (PointObject& point : scene.points) {
    point.place.lat = point.place.lat + Angle::degrees(1.3);
    point.icon.heading = Angle::degrees(33.0);
    edits.moves.push_back({point.of.id, point.place, point.icon.heading});
  }
  ASSERT_TRUE(globe_->edit_objects(layer, edits));
  EXPECT_EQ(settle(*globe_, kIconsSeen).objects_cut, 0U);
  const auto moved = picture().rgba;
  ASSERT_TRUE(globe_->set_objects(layer, scene));
  settle(*globe_, kIconsSeen);
  EXPECT_EQ(picture().rgba, moved);
}

TEST_F(Icons, FaultyPicturesAreRefusedWithACure) {
  PointObject point = icon(1, icon_at(0, 0));
  const auto refused = [&](const PointObject& wrong) {
    const auto added = globe_->add_objects({.points = {wrong}});
    return added ? std::string() : added.error().message;
  };
  point.icon.image = std::make_shared<const IconImage>(IconImage{8, 8, {1, 2, 3}});
  EXPECT_EQ(refused(point),
            "Globe::add_objects: points[0]: its icon: its picture of 8x8 pixels has 3 bytes; give 4 for each pixel");
  point.icon.image = icon_image(257, 1);
  EXPECT_THAT(refused(point), HasSubstr("the width of its picture is 257 px; give 1 px to 256 px"));
  point.icon.image = std::make_shared<const IconImage>();
  EXPECT_THAT(refused(point), HasSubstr("the width of its picture is 0 px"));
  point = icon(1, icon_at(0, 0));
  point.size_px = 0.0F;
  EXPECT_THAT(refused(point), HasSubstr("its icon has the size 0; give more"));
  ObjectScene many;
  for (std::size_t k = 0; k <= kMostIcons; ++k) {
    many.points.push_back(icon(k + 1, icon_at(0, 0)));
    many.points.back().icon.image = icon_image(1, 1);
  }
  const PointObject last = many.points.back();
  EXPECT_THAT(globe_->add_objects(many).error().message, HasSubstr("513 different icons in a layer are more than 512"));
  many.points.pop_back();
  const auto layer = globe_->add_objects(many);
  ASSERT_TRUE(layer);
  const Status edited = globe_->edit_objects(*layer, {.remove = {ObjectId{1}}, .add = {.points = {last}}});
  EXPECT_THAT(edited.error().message, HasSubstr("513 different icons"));
  EXPECT_THAT(edited.error().message, HasSubstr("No edit is made"));
}

// Two GeoJSON files number their features alike.
TEST_F(Icons, AnIdThatNamesTwoFeaturesIsRefused) {
  const auto feature = [](const char* json) { return std::make_shared<const ObjectFeature>(ObjectFeature{json}); };
  const auto scene = [&](std::uint64_t id, const char* json) {
    PointObject point = icon(id, icon_at(0, 0));
    point.of.feature = feature(json);
    return ObjectScene{.points = {point}, .labels = {{.text = "x", .of = {ObjectId{id}, feature(json)}}}};
  };
  const auto layer = globe_->add_objects(scene(1, R"({"of":"file 1"})"));
  ASSERT_TRUE(layer);
  const Status wrong = globe_->edit_objects(*layer, {.add = scene(1, R"({"of":"file 2"})")});
  EXPECT_THAT(wrong.error().message, HasSubstr("the id 1 names two features"));
  EXPECT_THAT(wrong.error().message, HasSubstr("read_geojson_objects"));
  EXPECT_TRUE(globe_->edit_objects(*layer, {.add = scene(2, R"({"of":"file 2"})")}));
  EXPECT_TRUE(globe_->edit_objects(*layer, {.add = {.points = {icon(1, icon_at(1, 1))}}})) << "a part without data";
  EXPECT_TRUE(globe_->edit_objects(*layer, {.remove = {ObjectId{1}}, .add = scene(1, R"({"of":"file 3"})")}));
  ObjectScene both = scene(1, "{}");
  both.points.push_back(scene(1, R"({"of":"file 2"})").points[0]);
  EXPECT_FALSE(globe_->add_objects(both));
  EXPECT_FALSE(globe_->set_objects(*layer, both));
}

}  // namespace
}  // namespace terrella::test
