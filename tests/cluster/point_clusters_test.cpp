// Clusters of a layer: drawn, picked, opened by coming nearer, and taken away.
#include "globe/features/point_clusters.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "tests/gl/gl_fixture.h"
#include "tests/scene/patch_test_support.h"
#include "tests/support/label_font.h"

namespace terrella::test {
namespace {

using testing::HasSubstr;
using testing::SizeIs;

constexpr Viewport kClusters{240, 180};

/// Thirty markers within 0.3 degrees of 0, 0, and one at 14, 18 degrees.
ObjectScene thirty_and_one() {
  ObjectScene scene;
  for (std::uint64_t i = 1; i <= 31; ++i) {
    const double lat = i == 31 ? 14.0 : 0.05 * double(i / 6) - 0.1, lon = i == 31 ? 18.0 : 0.05 * double(i % 6) - 0.1;
    scene.points.push_back({.place = {.lat = Angle::degrees(lat), .lon = Angle::degrees(lon)},
                            .size_px = 9.0F,
                            .color = {220, 20, 20},
                            .of = {.id = ObjectId{i}},
                            .heights = HeightMode::clamp_to_ground});
  }
  return scene;
}

class PointClustersTest : public GlTest {
 protected:
  void SetUp() override {
    GlTest::SetUp();
    GlobeOptions options = unlit_options();
    options.label_font = label_font();
    globe_ = *Globe::create(options);
    layer_ = *globe_->add_objects(thirty_and_one());
  }
  void TearDown() override {
    globe_.reset();
    GlTest::TearDown();
  }
  PointClusters clusters() { return *PointClusters::make(layer_, cluster_points(thirty_and_one()), 40.0); }

  std::vector<std::uint8_t> pixels(double height_m, PointClusters* clusters) {
    globe_->set_camera(camera_at(0, 0, height_m));
    EXPECT_TRUE(clusters == nullptr || clusters->update(*globe_, kClusters));
    settle(*globe_, kClusters);
    return picture().rgba;
  }
  [[nodiscard]] GlobePick pick(double lat, double lon) const {
    const auto pixel = globe_->project({.lat = Angle::degrees(lat), .lon = Angle::degrees(lon)}, kClusters);
    return pixel ? globe_->pick(*pixel, kClusters) : GlobePick{};
  }

  std::unique_ptr<Globe> globe_;
  LayerId layer_ = LayerId::none;
};

TEST_F(PointClustersTest, AClusterIsPickedAndComesApartFromNearby) {
  const auto plain_far = pixels(6.0e6, nullptr), plain_near = pixels(1.2e4, nullptr);
  PointClusters grouped = clusters();
  EXPECT_NE(pixels(6.0e6, &grouped), plain_far);
  const GlobePick cluster = pick(0.02, 0.02);
  ASSERT_TRUE(cluster.object);
  EXPECT_EQ(cluster.objects, layer_);
  const std::vector<ObjectId> features = grouped.features_of(cluster.object->of.id);
  EXPECT_THAT(features, SizeIs(30));
  EXPECT_EQ(features.front(), ObjectId{1});
  EXPECT_THAT(cluster.object->of.feature->properties, HasSubstr("\"point_count\":30"));
  const GlobePick alone = pick(14, 18);
  ASSERT_TRUE(alone.object);
  EXPECT_EQ(alone.object->of.id, ObjectId{31});
  EXPECT_THAT(grouped.features_of(ObjectId{31}), SizeIs(0));
  EXPECT_EQ(pixels(1.2e4, &grouped), plain_near);
  EXPECT_NE(pixels(6.0e6, &grouped), plain_far);
  EXPECT_TRUE(grouped.end(*globe_));
  EXPECT_EQ(pixels(6.0e6, nullptr), plain_far);
  const GlobePick single = pick(-0.1, -0.1);
  ASSERT_TRUE(single.object);
  EXPECT_LE(single.object->of.id, ObjectId{30});
}

TEST_F(PointClustersTest, OnlyLonePointsAreInClusters) {
  ObjectScene scene = thirty_and_one();
  scene.points[0].radius_m = 1000.0;              // a sphere
  scene.points[1].of.id = ObjectId::none;         // nothing to edit it by
  scene.points[2].of.id = scene.points[3].of.id;  // two points of one feature
  scene.lines.push_back({.places = {scene.points[4].place, scene.points[5].place}, .of = scene.points[4].of});
  EXPECT_THAT(cluster_points(scene), SizeIs(31 - 5));
}

TEST_F(PointClustersTest, FaultsAreNamed) {
  for (const double radius_px : {9.0, 401.0, std::numeric_limits<double>::quiet_NaN()}) {
    const auto made = PointClusters::make(layer_, {}, radius_px);
    ASSERT_FALSE(made);
    EXPECT_THAT(made.error().message, HasSubstr("radius"));
  }
  PointClusters grouped = clusters();
  ASSERT_TRUE(globe_->remove(layer_));
  EXPECT_FALSE(grouped.update(*globe_, kClusters));
}

}  // namespace
}  // namespace terrella::test
