// The edits that give features their own look back.

#include "streaming/objects/classes/layer_features.h"

#include <gtest/gtest.h>

#include <sstream>

#include "streaming/objects/geojson_objects.h"

namespace terrella {
namespace {

ObjectScene scene_of(const std::string& features) {
  std::istringstream text(R"({"type":"FeatureCollection","features":[)" + features + "]}");
  auto file = parse_geojson_objects(text, "f.geojson", {});
  EXPECT_TRUE(file) << file.error().message;
  return file ? std::move(file->scene) : ObjectScene();
}

std::string feature(const std::string& geometry, const std::string& properties) {
  return R"({"type":"Feature","geometry":)" + geometry + R"(,"properties":)" + properties + "}";
}

const std::string kPoint = R"({"type":"Point","coordinates":[1,2]})";
const std::string kLine = R"({"type":"LineString","coordinates":[[1,2],[3,4]]})";
const std::string kArea = R"({"type":"Polygon","coordinates":[[[0,0],[1,0],[1,1],[0,0]]]})";

TEST(LayerFeatures, KeepTheColoursAndSizesOfEachKind) {
  const LayerFeatures all = layer_features(
      scene_of(feature(kPoint, R"({"marker-color":"#010203","marker-size":20,"title":"t","text-size":20})") + "," +
               feature(kLine, R"({"stroke":"#040506","stroke-width":7,"stroke-opacity":0.2})") + "," +
               feature(kArea, R"({"fill":"#070809","fill-opacity":1,"stroke":"#0a0b0c"})")));
  ASSERT_EQ(all.parts.size(), 3U);
  ASSERT_EQ(all.own.changes.size(), 3U);
  const ObjectChange &point = all.own.changes[0], &line = all.own.changes[1], &area = all.own.changes[2];
  EXPECT_EQ(point.id, ObjectId{1});
  EXPECT_EQ(point.color, (ObjectColor{1, 2, 3}));
  EXPECT_EQ(point.size_px, 20.0F);
  EXPECT_EQ(point.label, (ObjectColor{255, 255, 255}));
  EXPECT_EQ(point.look, LabelLook{.text_px = 20.0F});
  EXPECT_EQ(line.color, (ObjectColor{4, 5, 6, 51}));
  EXPECT_EQ(line.size_px, 7.0F);
  EXPECT_FALSE(line.fill);
  EXPECT_EQ(area.fill, (ObjectColor{7, 8, 9}));
  EXPECT_EQ(area.color, (ObjectColor{10, 11, 12}));
  EXPECT_TRUE(all.own.remove.empty());
  EXPECT_TRUE(all.own.add.empty());
}

TEST(LayerFeatures, HideAgainALineWithoutWidth) {
  const LayerFeatures all = layer_features(scene_of(feature(kLine, R"({"stroke":"#040506","stroke-width":0})")));
  ASSERT_EQ(all.own.changes.size(), 1U);
  EXPECT_EQ(all.own.changes[0].color, (ObjectColor{4, 5, 6, 0}));
  EXPECT_FALSE(all.own.changes[0].size_px) << "an edit takes positive sizes alone";
}

TEST(LayerFeatures, AddAFeatureOfSeveralKindsAgain) {
  const std::string both = R"({"type":"GeometryCollection","geometries":[)" + kPoint + "," + kLine + "]}";
  const LayerFeatures all = layer_features(
      scene_of(feature(both, R"({"marker-color":"#010203","stroke":"#040506"})") + "," + feature(kPoint, "{}")));
  ASSERT_EQ(all.parts.size(), 2U);
  EXPECT_EQ(all.own.remove, std::vector{ObjectId{1}});
  ASSERT_EQ(all.own.add.points.size(), 1U);
  EXPECT_EQ(all.own.add.points[0].color, (ObjectColor{1, 2, 3}));
  ASSERT_EQ(all.own.add.lines.size(), 1U);
  EXPECT_EQ(all.own.add.lines[0].color, (ObjectColor{4, 5, 6}));
  ASSERT_EQ(all.own.changes.size(), 1U);
  EXPECT_EQ(all.own.changes[0].id, ObjectId{2});
}

}  // namespace
}  // namespace terrella
