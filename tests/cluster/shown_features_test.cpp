// Features that are shown at some zoom levels and instants only.
#include "globe/features/shown_features.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/gl/gl_fixture.h"
#include "tests/scene/patch_test_support.h"

namespace terrella::test {
namespace {

using testing::HasSubstr;

constexpr Viewport kPicture{240, 180};
constexpr ObjectId kDisc{1}, kArea{2}, kTrack{3};

Geodetic at(double lat, double lon) { return {.lat = Angle::degrees(lat), .lon = Angle::degrees(lon)}; }

/// A disc at 0, 0; an area and a line on the ground right of it and above it.
ObjectScene three_features() {
  ObjectScene scene;
  scene.points.push_back({.place = at(0, 0), .size_px = 15.0F, .of = {.id = kDisc}});
  scene.polygons.push_back({.rings = {{at(-0.05, 0.1), at(-0.05, 0.2), at(0.05, 0.2), at(0.05, 0.1)}},
                            .fill = {20, 220, 20},
                            .of = {.id = kArea},
                            .heights = HeightMode::clamp_to_ground});
  scene.lines.push_back({.places = {at(0.2, -0.1), at(0.2, 0.1)},
                         .width_px = 6.0F,
                         .of = {.id = kTrack},
                         .heights = HeightMode::absolute});
  return scene;
}

class ShownFeaturesTest : public GlTest {
 protected:
  void SetUp() override {
    GlTest::SetUp();
    globe_ = *Globe::create(unlit_options());
    layer_ = *globe_->add_objects(three_features());
  }
  void TearDown() override {
    globe_.reset();
    GlTest::TearDown();
  }
  std::vector<std::uint8_t> pixels(ShownFeatures* features = nullptr) {
    EXPECT_TRUE(features == nullptr || features->update(*globe_, kPicture));
    settle(*globe_, kPicture);
    return picture().rgba;
  }
  /// The feature that a click finds; none for the ground.
  [[nodiscard]] ObjectId picked(const Geodetic& place) const {
    const auto pixel = globe_->project(place, kPicture);
    const GlobePick pick = pixel ? globe_->pick(*pixel, kPicture) : GlobePick{};
    return pick.object ? pick.object->of.id : ObjectId::none;
  }
  void look_from(double height_m, double pitch_deg = -90.0) {
    Camera camera = camera_at(0, 0, height_m);
    camera.pitch = Angle::degrees(pitch_deg);
    globe_->set_camera(camera);
  }
  ShownFeatures make(std::vector<ShownWhen> features) { return *ShownFeatures::make(layer_, std::move(features)); }

  std::unique_ptr<Globe> globe_;
  LayerId layer_ = LayerId::none;
};

// 2 · pi · a / (512 · 2^z) metres a pixel, with a field of view that is straight down: one pixel is 2 h tan(fov / 2) /
// n.
TEST_F(ShownFeaturesTest, TheZoomLevelIsThatOfTheGroundBelow) {
  for (const double height_m : {1.0e3, 1.0e5, 7.0e6}) {
    look_from(height_m);
    const Camera& camera = globe_->camera();
    const double pixel_m = 2.0 * height_m * std::tan(0.5 * camera.fov_y.rad()) / kPicture.height_px;
    const double zoom = std::log2(2.0 * std::numbers::pi * 6378137.0 / 512.0 / pixel_m);
    EXPECT_NEAR(zoom_of(*globe_, kPicture), zoom, 1e-9);
    look_from(height_m, -10.0);
    EXPECT_NEAR(zoom_of(*globe_, kPicture), zoom, 1e-9) << "whatever the direction of view";
    EXPECT_NEAR(zoom_of(*globe_, {480, 360}), zoom + 1.0, 1e-9) << "twice the pixels";
  }
  look_from(1e10);
  EXPECT_EQ(zoom_of(*globe_, kPicture), kLeastZoom);
}

TEST_F(ShownFeaturesTest, FeaturesComeAndGoWithTheZoomAndAllComeBack) {
  look_from(1.0e5);
  const double zoom = zoom_of(*globe_, kPicture);
  const auto all = pixels();
  EXPECT_EQ(picked(at(0, 0)), kDisc);
  EXPECT_EQ(picked(at(0.0, 0.15)), kArea);
  ShownFeatures features = make({{.id = kDisc, .from_zoom = zoom + 0.5}, {.id = kArea, .before_zoom = zoom + 0.5}});
  const auto without_disc = pixels(&features);
  EXPECT_NE(without_disc, all);
  EXPECT_EQ(picked(at(0, 0)), ObjectId::none);
  EXPECT_EQ(picked(at(0.0, 0.15)), kArea);
  EXPECT_EQ(picked(at(0.2, 0.0)), kTrack) << "it has no bounds";
  look_from(6.0e4);  // 0.74 levels nearer
  pixels(&features);
  EXPECT_EQ(picked(at(0, 0)), kDisc);
  EXPECT_EQ(picked(at(0.0, 0.15)), ObjectId::none);
  look_from(1.0e5);
  EXPECT_EQ(pixels(&features), without_disc) << "the second time as the first";
  EXPECT_TRUE(features.end(*globe_));
  EXPECT_EQ(pixels(), all);
}

TEST_F(ShownFeaturesTest, InstantsAreThoseOfTheGlobe) {
  const auto day = [](int number) { return *parse_utc("2026-06-0" + std::to_string(number)); };
  look_from(1.0e5);
  ShownFeatures features = make({{.id = kDisc, .from = day(2), .before = day(4)},
                                 {.id = kArea, .from = day(3)},
                                 {.id = kTrack, .before = day(3)}});
  const auto shown_on = [&](std::optional<UtcTime> time) {
    EXPECT_TRUE(globe_->set_time(time));
    pixels(&features);
    std::string shown;
    if (picked(at(0, 0)) == kDisc) shown += "disc ";
    if (picked(at(0.0, 0.15)) == kArea) shown += "area ";
    if (picked(at(0.2, 0.0)) == kTrack) shown += "track ";
    return shown;
  };
  for (int times = 0; times < 2; ++times) {
    EXPECT_EQ(shown_on(day(1)), "track ");
    EXPECT_EQ(shown_on(day(2)), "disc track ");
    EXPECT_EQ(shown_on(day(4)), "area ");
    EXPECT_EQ(shown_on(day(3)), "disc area ");
    EXPECT_EQ(shown_on(std::nullopt), "disc area track ") << "without a time all are shown";
  }
}

TEST_F(ShownFeaturesTest, HidingByTheApplicationIsAnotherMatter) {
  look_from(1.0e5);
  const double zoom = zoom_of(*globe_, kPicture);
  ShownFeatures features = make({{.id = kDisc, .from_zoom = zoom + 0.5}});
  pixels(&features);
  ObjectEdits hide;
  hide.changes = {{.id = kDisc, .visible = false}};
  EXPECT_TRUE(globe_->edit_objects(layer_, hide));
  look_from(6.0e4);
  pixels(&features);
  EXPECT_EQ(picked(at(0, 0)), ObjectId::none) << "the zoom shows it, the application does not";
  hide.changes[0].visible = true;
  EXPECT_TRUE(globe_->edit_objects(layer_, hide));
  pixels(&features);
  EXPECT_EQ(picked(at(0, 0)), kDisc);
}

TEST_F(ShownFeaturesTest, ALevelOutOfItsRangeAndALayerThatIsGoneAreErrors) {
  const auto made = ShownFeatures::make(layer_, {{.id = kDisc, .from_zoom = -1.0}});
  ASSERT_FALSE(made);
  EXPECT_THAT(made.error().message, HasSubstr("from which a feature is shown"));
  look_from(1.0e5);
  ShownFeatures features = make({{.id = kDisc, .from_zoom = 24.0}});
  EXPECT_TRUE(globe_->remove(layer_));
  EXPECT_FALSE(features.update(*globe_, kPicture));
}

}  // namespace
}  // namespace terrella::test
