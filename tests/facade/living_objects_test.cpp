// Edits of single objects: what they change, what they leave alone, and what they cost, counted.
#include <gtest/gtest.h>

#include <memory>
#include <utility>

#include "tests/facade/geodetic_at.h"
#include "tests/gl/gl_fixture.h"
#include "tests/scene/patch_test_support.h"
#include "tests/support/label_font.h"

namespace terrella::test {
namespace {

constexpr Viewport kLiving{160, 120};
constexpr ObjectColor kRed{220, 20, 20}, kGreen{20, 200, 20};

ObjectIdentity named(std::uint64_t id) { return {.id = ObjectId{id}}; }

PointObject marker(std::uint64_t id, const Geodetic& place, ObjectColor color = kRed) {
  return {.place = place, .size_px = 9.0F, .color = color, .of = named(id)};
}
PolygonObject box(std::uint64_t id, double south, double west, ObjectColor fill = kRed) {
  return {.rings = {{at(south, west), at(south, west + 4), at(south + 4, west + 4), at(south + 4, west)}},
          .fill = fill,
          .stroke = {10, 10, 10},
          .of = named(id)};
}
std::shared_ptr<const MeshModel> flag() {
  MeshModel model;
  model.parts.push_back(
      {.vertices = {{.position_m = {-2e5F, 0, 0}}, {.position_m = {2e5F, 0, 0}}, {.position_m = {0, 0, 3e5F}}},
       .indices = {0, 1, 2},
       .color_linear = {0.1F, 0.7F, 0.2F, 1.0F}});
  return std::make_shared<const MeshModel>(model);
}

class LivingObjects : public GlTest {
 protected:
  void SetUp() override {
    GlTest::SetUp();
    auto globe = Globe::create(unlit_options());
    ASSERT_TRUE(globe);
    globe_ = *std::move(globe);
    globe_->set_camera(camera_at(0, 0, 5.0e6));
  }
  void TearDown() override {
    globe_.reset();
    GlTest::TearDown();
  }
  /// Takes another globe, with labels, which are not drawn without light.
  void use_labels(double height_m) {
    GlobeOptions options = unlit_options();
    options.unlit = false;
    options.label_font = label_font();
    globe_ = *Globe::create(options);
    globe_->set_camera(camera_at(0, 0, height_m));
  }
  std::vector<std::uint8_t> pixels() {
    settle(*globe_, kLiving);
    return picture().rgba;
  }
  [[nodiscard]] GlobePick pick(const Geodetic& place) const {
    const auto pixel = globe_->project(place, kLiving);
    return pixel ? globe_->pick(*pixel, kLiving) : GlobePick{};
  }
  std::unique_ptr<Globe> globe_;
};

// An edited layer shows the same pixels as one that was set to what the edits lead to.
TEST_F(LivingObjects, AnEditedLayerIsDrawnAsIfItWereNew) {
  const auto model = flag();
  ObjectScene scene;
  for (std::uint64_t k = 0; k < 6; ++k) scene.points.push_back(marker(k + 1, at(-10, -12.0 + 4.0 * double(k))));
  for (std::uint64_t k = 0; k < 6; ++k) {
    scene.points.push_back(
        {.place = at(-4, -12.0 + 4.0 * double(k), 1e4), .radius_m = 8e4, .color = kGreen, .of = named(11 + k)});
  }
  scene.lines = {{.places = {at(10, -14), at(10, -2)}, .of = named(21)},
                 {.places = {at(10, 2), at(10, 14)}, .of = named(22)}};
  scene.polygons = {box(31, 2, -12), box(32, 2, -4), box(33, 2, 4)};
  scene.meshes = {{.model = model, .place = at(-8, -14, 5e3), .of = named(41)},
                  {.model = model, .place = at(-8, 14, 5e3), .of = named(42)}};
  const LayerId layer = *globe_->add_objects(scene);
  const auto before = pixels();

  ObjectEdits edits;
  edits.remove = {ObjectId{3}, ObjectId{13}, ObjectId{22}, ObjectId{32}, ObjectId{41}};
  edits.add.points = {marker(51, at(-13, 0), kGreen)};
  edits.add.polygons = {box(52, -2, 8, kGreen)};
  edits.moves = {{ObjectId{1}, at(-13, -8)},
                 {ObjectId{11}, at(-1, -14, 1e4)},
                 {ObjectId{42}, at(6, 14, 5e3)},
                 {ObjectId{2}, at(-13, 6, -2e3)}};
  edits.changes = {{.id = ObjectId{4}, .color = ObjectColor{0, 0, 250, 120}, .size_px = 14.0F},
                   {.id = ObjectId{12}, .color = ObjectColor{250, 250, 0}},
                   {.id = ObjectId{21}, .color = ObjectColor{0, 220, 220, 128}, .size_px = 5.0F},
                   {.id = ObjectId{31}, .color = ObjectColor{240, 240, 240}, .fill = ObjectColor{0, 0, 99, 99}},
                   {.id = ObjectId{42}, .heading = Angle::degrees(90.0)}};
  ASSERT_TRUE(globe_->edit_objects(layer, edits));
  EXPECT_TRUE(globe_->needs_frame());
  const auto edited = pixels();
  EXPECT_NE(edited, before);

  ObjectScene wanted = scene;
  wanted.points[0].place = at(-13, -8);
  wanted.points[1].place = at(-13, 6, -2e3);
  wanted.points[3].color = {0, 0, 250, 120};
  wanted.points[3].size_px = 14.0F;
  wanted.points[6].place = at(-1, -14, 1e4);
  wanted.points[7].color = {250, 250, 0};
  wanted.points.push_back(edits.add.points[0]);
  wanted.points.erase(wanted.points.begin() + 8);
  wanted.points.erase(wanted.points.begin() + 2);
  wanted.lines[0].color = {0, 220, 220, 128};
  wanted.lines[0].width_px = 5.0F;
  wanted.lines.pop_back();
  wanted.polygons[0].stroke = {240, 240, 240};
  wanted.polygons[0].fill = {0, 0, 99, 99};
  wanted.polygons[1] = wanted.polygons[2];
  wanted.polygons[2] = edits.add.polygons[0];
  wanted.meshes.erase(wanted.meshes.begin());
  wanted.meshes[0].place = at(6, 14, 5e3);
  wanted.meshes[0].heading = Angle::degrees(90.0);
  ASSERT_TRUE(globe_->set_objects(layer, wanted));
  EXPECT_EQ(pixels(), edited);
}

TEST_F(LivingObjects, AnObjectThatIsHiddenOrSelectedComesBackAsItWas) {
  const auto empty = pixels();
  const LayerId layer = *globe_->add_objects({.points = {marker(1, at(0, 0)), marker(1, at(3, 3), {0, 0, 250, 90})},
                                              .lines = {{.places = {at(8, -8), at(8, 8)}, .of = named(1)}},
                                              .polygons = {box(1, -8, -8), box(1, -8, 4, {0, 90, 0, 90})},
                                              .meshes = {{.model = flag(), .place = at(4, -9, 5e3), .of = named(1)}}});
  const auto before = pixels();
  EXPECT_EQ(pick(at(0, 0)).object->of.id, ObjectId{1});
  ASSERT_TRUE(globe_->edit_objects(layer, {.changes = {{.id = ObjectId{1}, .visible = false}}}));
  EXPECT_EQ(pixels(), empty);
  EXPECT_FALSE(pick(at(0, 0)).object);
  EXPECT_FALSE(pick(at(-6, -6)).object);
  ASSERT_TRUE(globe_->edit_objects(layer, {.changes = {{.id = ObjectId{1}, .visible = true, .selected = true}},
                                           .selected_color = ObjectColor{250, 0, 250}}));
  EXPECT_EQ(draw(*globe_, kLiving).objects_cut, 0U);
  EXPECT_EQ(picture().at(80, 60), (Color{250, 0, 250})) << "the next frame shows it";
  ASSERT_TRUE(globe_->edit_objects(layer, {.changes = {{.id = ObjectId{1}, .selected = false}}}));
  EXPECT_EQ(pixels(), before);
  ASSERT_TRUE(globe_->edit_objects(layer, {.remove = {ObjectId{1}}}));
  EXPECT_EQ(pixels(), empty);
}

TEST_F(LivingObjects, OnlyAShapeThatIsNewIsCut) {
  const auto cut = [this] { return draw(*globe_, kLiving).objects_cut; };
  const LayerId layer =
      *globe_->add_objects({.points = {marker(1, at(0, 0))}, .polygons = {box(2, 0, 0), box(3, 5, 5)}});
  EXPECT_EQ(cut(), 2U);
  ASSERT_TRUE(globe_->edit_objects(
      layer, {.remove = {ObjectId{3}},
              .moves = {{ObjectId{1}, at(1, 1)}, {ObjectId{2}, at(2, 2)}},
              .changes = {{.id = ObjectId{2}, .selected = true, .fill = kGreen, .size_px = 4.0F}}}));
  ASSERT_TRUE(globe_->fade_objects(layer, 0.5));
  EXPECT_EQ(cut(), 0U);
  ASSERT_TRUE(globe_->edit_objects(layer, {.add = {.polygons = {box(4, -9, -9)}}}));
  EXPECT_EQ(cut(), 1U);
  PolygonObject clear = box(5, -9, 3);
  clear.fill.alpha = clear.stroke.alpha = 0;
  ASSERT_TRUE(globe_->edit_objects(layer, {.add = {.polygons = {clear}}}));
  EXPECT_EQ(cut(), 0U) << "without a colour there is nothing to cut";
  ASSERT_TRUE(globe_->edit_objects(layer, {.changes = {{.id = ObjectId{5}, .fill = kGreen}}}));
  EXPECT_EQ(cut(), 1U);
  EXPECT_EQ(pick(at(-7, 5)).object->of.id, ObjectId{5});
}

TEST_F(LivingObjects, AnEditThatCannotBeMadeIsNamedAndTheOthersAreMade) {
  const LayerId layer = *globe_->add_objects({.points = {marker(1, at(0, 0)), marker(2, at(5, 5))}});
  const Status unknown = globe_->edit_objects(
      layer, {.remove = {ObjectId{99}}, .moves = {{ObjectId{98}, at(1, 1)}, {ObjectId{1}, at(6, -6)}}});
  ASSERT_FALSE(unknown);
  EXPECT_NE(unknown.error().message.find("no object 99 and 1 other"), std::string::npos) << unknown.error().message;
  EXPECT_EQ(pick(at(6, -6)).object->of.id, ObjectId{1});
  const Status size = globe_->edit_objects(
      layer, {.changes = {{.id = ObjectId{1}, .size_px = -1.0F}, {.id = ObjectId{2}, .visible = false}}});
  ASSERT_FALSE(size);
  EXPECT_NE(size.error().message.find("-1 px"), std::string::npos) << size.error().message;
  EXPECT_FALSE(pick(at(5, 5)).object);
  ASSERT_TRUE(globe_->remove(layer));
  EXPECT_FALSE(globe_->edit_objects(layer, {}));
}

TEST_F(LivingObjects, APickReturnsTheFeature) {
  const auto feature =
      std::make_shared<const ObjectFeature>(ObjectFeature{.properties = R"({"name": "Ada"})", .user = 7});
  const LayerId layer = *globe_->add_objects({.points = {marker(1, at(9, 9))}, .polygons = {box(2, -2, -2)}});
  PointObject point = marker(3, at(-8, 8));
  point.of.feature = feature;
  ASSERT_TRUE(globe_->edit_objects(layer, {.add = {.points = {point}}}));
  const GlobePick found = pick(at(-8, 8));
  ASSERT_TRUE(found.object);
  EXPECT_EQ(found.objects, layer);
  EXPECT_EQ(found.object->of.id, ObjectId{3});
  EXPECT_EQ(found.object->kind, ObjectKind::point);
  EXPECT_EQ(found.object->index, 1U) << "counted on from the scene's points";
  EXPECT_EQ(found.object->of.feature->properties, R"({"name": "Ada"})");
  EXPECT_EQ(found.object->of.feature->user, 7U);
  EXPECT_EQ(pick(at(0, 0)).object->of.id, ObjectId{2});
}

// Towards the middle of the disc the ground is nearer to the eye than the label's place: it must not hide the text.
TEST_F(LivingObjects, ALabelIsWholeNearTheLimb) {
  use_labels(1.4e7);
  constexpr Viewport kLarge{480, 360};
  const auto ink = [&](double lat_deg, double lon_deg) {
    const LayerId layer = *globe_->add_objects(
        {.labels = {{.text = "Reykholmavik", .place = at(lat_deg, lon_deg), .color = {255, 0, 255}}}});
    settle(*globe_, kLarge);
    const Picture seen = picture();
    EXPECT_TRUE(globe_->remove(layer));
    int pixels = 0;
    for (int y = 0; y < kLarge.height_px; ++y) {
      for (int x = 0; x < kLarge.width_px; ++x) {
        const Color color = seen.at(x, y);
        pixels += color[0] > 180 && color[2] > 180 && color[1] < 90 ? 1 : 0;
      }
    }
    return pixels;
  };
  const int whole = ink(0, 0);
  EXPECT_GT(whole, 150);
  for (const auto& [lat, lon] : {std::pair{0.0, -68.0}, {0.0, 68.0}, {66.0, 0.0}, {-66.0, 0.0}, {48.0, -48.0}}) {
    EXPECT_NEAR(ink(lat, lon), whole, 0.08 * whole)
        << "more than the edges of letters on other ground: " << lat << ", " << lon;
  }
}

// A label is drawn to the right of its marker. It moves with the marker, and is picked by its text.
TEST_F(LivingObjects, ALabelIsPickedWhereItsTextIs) {
  use_labels(5.0e6);
  const LayerId layer =
      *globe_->add_objects({.points = {marker(1, at(0, 0))},
                            .labels = {{.text = "WW", .place = at(0, 0), .size_px = 9.0F, .of = named(1)}}});
  settle(*globe_, kLiving);
  const auto beside = [this](const Geodetic& place, double right_px) {
    return globe_->pick(*globe_->project(place, kLiving) + glm::dvec2(right_px, 0.0), kLiving).object;
  };
  const auto found = beside(at(0, 0), 20.0);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->kind, ObjectKind::label);
  EXPECT_EQ(found->of.id, ObjectId{1});
  EXPECT_EQ(beside(at(0, 0), 0.0)->kind, ObjectKind::point);
  EXPECT_FALSE(beside(at(0, 0), 55.0));
  ASSERT_TRUE(globe_->edit_objects(layer, {.moves = {{ObjectId{1}, at(9, -9)}}, .texts = {{ObjectId{1}, "WWWW"}}}));
  settle(*globe_, kLiving);
  EXPECT_FALSE(beside(at(0, 0), 20.0));
  ASSERT_TRUE(beside(at(9, -9), 55.0));
  EXPECT_EQ(beside(at(9, -9), 55.0)->kind, ObjectKind::label);
  const ObjectChange left_of_it{.id = ObjectId{1}, .look = LabelLook{.anchor = TextAnchor::right}};
  ASSERT_TRUE(globe_->edit_objects(layer, {.moves = {{ObjectId{1}, at(9, 9)}}, .changes = {left_of_it}}));
  settle(*globe_, kLiving);
  EXPECT_FALSE(beside(at(9, 9), 55.0));
  ASSERT_TRUE(beside(at(9, 9), -55.0));
  EXPECT_EQ(beside(at(9, 9), -55.0)->kind, ObjectKind::label);
  ASSERT_TRUE(globe_->edit_objects(layer, {.changes = {{.id = ObjectId{1}, .visible = false}}}));
  EXPECT_FALSE(beside(at(9, 9), -55.0)) << "at once";
}

// A worker cuts this many areas. The earlier scene stays until then, and an edit meanwhile is not lost.
TEST_F(LivingObjects, ALargeSceneIsDrawnOnceItIsCut) {
  const LayerId layer = *globe_->add_objects({.polygons = {box(1, -2, -2, kGreen)}});
  settle(*globe_, kLiving);
  EXPECT_EQ(picture().at(80, 60), (Color{20, 200, 20}));
  ObjectScene many;
  for (std::uint64_t k = 0; k < 60; ++k) many.polygons.push_back(box(k + 1, -60.0 + double(k), -2, kRed));
  for (PolygonObject& area : many.polygons) {
    area.stroke.alpha = 0;
    area.heights = HeightMode::relative_to_ground;  // areas on the ground are not cut
  }
  ASSERT_TRUE(globe_->set_objects(layer, many));
  ASSERT_TRUE(globe_->edit_objects(layer, {.changes = {{.id = ObjectId{60}, .fill = ObjectColor{0, 0, 250}}}}));
  EXPECT_FALSE(globe_->settled());
  std::size_t cut = 0;
  for (int frame = 0; frame < 1000 && !globe_->settled(); ++frame) {
    cut += draw(*globe_, kLiving).objects_cut;
    if (cut == 0) {
      ASSERT_EQ(picture().at(80, 60), (Color{20, 200, 20})) << "the earlier scene, frame " << frame;
    }
  }
  EXPECT_EQ(cut, 60U);
  EXPECT_EQ(picture().at(80, 60), (Color{0, 0, 250}));
  ASSERT_TRUE(globe_->set_objects(layer, many));
  ASSERT_TRUE(globe_->remove(layer)) << "a worker's job is left alone";
}

}  // namespace
}  // namespace terrella::test
