#include "streaming/objects/geojson_objects.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <ctime>
#include <fstream>
#include <sstream>
#include <utility>
#include <vector>

namespace terrella {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

Result<ObjectFile> parsed(const std::string& text) {
  std::istringstream stream(text);
  return parse_geojson_objects(stream, "f.geojson");
}

ObjectFile good(const std::string& text) {
  auto file = parsed(text);
  EXPECT_TRUE(file) << file.error().message;
  return file ? *std::move(file) : ObjectFile{};
}

std::string feature(const std::string& geometry, const std::string& properties = "{}") {
  return fmt::format(R"({{"type":"Feature","properties":{},"geometry":{}}})", properties, geometry);
}
std::string geometry(const std::string& type, const std::string& coordinates) {
  return fmt::format(R"({{"type":"{}","coordinates":{}}})", type, coordinates);
}
std::string collection(const std::string& features, const std::string& more = "") {
  return fmt::format(R"({{"type":"FeatureCollection",{}"features":[{}]}})", more, features);
}
const std::string kPoint = geometry("Point", "[8.5,47.25,-1200.5]");

TEST(GeojsonObjects, ReadsTheAttributionOfTheDocument) {
  const std::string inner = feature(kPoint, R"({"attribution":"of a feature"})");
  EXPECT_EQ(good(collection(inner)).attribution, "");
  EXPECT_EQ(good(collection(inner, R"("attribution":"Survey",)")).attribution, "Survey");
  EXPECT_EQ(good(R"({"features":[)" + inner + R"(],"attribution":"after","type":"FeatureCollection"})").attribution,
            "after");
  EXPECT_EQ(good(R"({"attribution":"alone",)" + inner.substr(1)).attribution, "alone");
  const ObjectFile odd = good(collection(inner, R"("attribution":7,)"));
  EXPECT_EQ(odd.attribution, "");
  EXPECT_THAT(odd.complaints, ElementsAre(HasSubstr("attribution")));
}

TEST(GeojsonObjects, ReadsEveryKindOfGeometryWithHeightsInMetres) {
  const ObjectFile file = good(collection(
      feature(kPoint) + "," + feature(geometry("MultiPoint", "[[1,2],[3,4,5]]")) + "," +
      feature(geometry("LineString", "[[0,0,10],[1,1,20],[2,0]]")) + "," +
      feature(geometry("MultiLineString", "[[[0,0],[1,1]],[[5,5],[6,6]]]")) + "," +
      feature(geometry("Polygon", "[[[0,0],[9,0],[9,9],[0,0]],[[5,1],[6,1],[6,2],[5,1]]]")) + "," +
      feature(geometry("MultiPolygon", "[[[[0,0],[9,0],[9,9],[0,0]]],[[[20,0],[29,0],[29,9],[20,0]]]]")) + "," +
      feature(R"({"type":"GeometryCollection","geometries":[)" + kPoint + "]}") + "," + feature("null")));
  EXPECT_THAT(file.complaints, ElementsAre());
  ASSERT_EQ(file.scene.points.size(), 4U);
  EXPECT_DOUBLE_EQ(file.scene.points[0].place.lat.deg(), 47.25);
  EXPECT_DOUBLE_EQ(file.scene.points[0].place.lon.deg(), 8.5);
  EXPECT_EQ(file.scene.points[0].place.height_m, -1200.5);
  EXPECT_TRUE(is_underground(file.scene.points[0]));
  EXPECT_FALSE(is_underground(file.scene.points[1]));
  ASSERT_EQ(file.scene.lines.size(), 3U);
  EXPECT_EQ(file.scene.lines[0].places[1].height_m, 20.0);
  ASSERT_EQ(file.scene.polygons.size(), 3U);
  EXPECT_EQ(file.scene.polygons[0].rings.size(), 2U);
  EXPECT_EQ(file.scene.polygons[0].rings[0].size(), 3U);
}

TEST(GeojsonObjects, ObjectsHaveTheNumberAndThePropertiesOfTheirFeature) {
  const ObjectFile file = good(collection(
      feature(kPoint) + "," +
      feature(geometry("MultiPoint", "[[1,2],[3,4]]"), R"({"title":"Zürich","people":[1,2.5],"description":"x"})")));
  ASSERT_EQ(file.scene.points.size(), 3U);
  EXPECT_EQ(file.scene.points[0].of.id, ObjectId{1});
  EXPECT_EQ(file.scene.points[0].of.feature->properties, "{}");
  ASSERT_EQ(file.scene.labels.size(), 2U);
  for (const ObjectIdentity& of : {file.scene.points[1].of, file.scene.points[2].of, file.scene.labels[1].of}) {
    EXPECT_EQ(of.id, ObjectId{2});
    EXPECT_EQ(of.feature->properties, R"({"description":"x","people":[1,2.5],"title":"Zürich"})");
  }
}

TEST(GeojsonObjects, ReadsAGeometryOrAFeatureThatIsTheWholeDocument) {
  EXPECT_EQ(good(kPoint).scene.points.size(), 1U);
  EXPECT_EQ(good(feature(kPoint)).scene.points.size(), 1U);
}

TEST(GeojsonObjects, AnAltitudeModeSaysWhatHeightsMean) {
  const ObjectFile file =
      good(collection(feature(kPoint, R"({"altitude-mode":"clampToGround","title":"Here"})") + "," +
                      feature(geometry("LineString", "[[0,0],[1,1]]"), R"({"altitude-mode":"relativeToGround"})") +
                      "," + feature(kPoint, R"({"altitude-mode":"absolute"})") + "," + feature(kPoint) + "," +
                      feature(kPoint, R"({"altitude-mode":"onTheSeaFloor"})")));
  EXPECT_THAT(file.complaints, ElementsAre(HasSubstr("\"altitude-mode\" must be absolute, clampToGround or")));
  EXPECT_EQ(file.scene.points[0].heights, HeightMode::clamp_to_ground);
  EXPECT_EQ(file.scene.labels[0].heights, HeightMode::clamp_to_ground);
  EXPECT_EQ(file.scene.lines[0].heights, HeightMode::relative_to_ground);
  EXPECT_EQ(file.scene.points[1].heights, HeightMode::absolute);
}

// The objects of a map have no heights. Over relief they would lie under the mountains.
TEST(GeojsonObjects, WithoutAThirdCoordinateLiesOnTheGround) {
  const ObjectFile file = good(
      collection(feature(geometry("MultiPoint", "[[1,2,3],[1,2]]"), R"({"title":"Here"})") + "," +
                 feature(geometry("MultiLineString", "[[[0,0],[1,1,0]],[[0,0],[1,1]]]")) + "," +
                 feature(geometry("MultiPolygon", "[[[[0,0,7],[9,0],[9,9],[0,0,7]]],[[[0,0],[9,0],[9,9],[0,0]]]]"))));
  ASSERT_EQ(file.scene.polygons.size(), 2U);
  for (const auto& [k, heights] : {std::pair{0U, HeightMode::absolute}, {1U, HeightMode::clamp_to_ground}}) {
    EXPECT_EQ(file.scene.points[k].heights, heights);
    EXPECT_EQ(file.scene.labels[k].heights, heights);
    EXPECT_EQ(file.scene.lines[k].heights, heights);
    EXPECT_EQ(file.scene.polygons[k].heights, heights);
  }
}

TEST(GeojsonObjects, AnAreaIsExtrudedByMetres) {
  const std::string area = geometry("Polygon", "[[[0,0],[9,0],[9,9],[0,0]]]");
  std::string features = feature(area, R"({"extrude_m":120.5})") + "," + feature(area);
  for (const char* wrong : {"\"tall\"", "-3", "2e9"}) {
    features += "," + feature(area, fmt::format(R"({{"extrude_m":{}}})", wrong));
  }
  const ObjectFile file = good(collection(features));
  const auto complaint = HasSubstr("\"extrude_m\" must be a number from 0 to 1000000000");
  EXPECT_THAT(file.complaints, ElementsAre(complaint, complaint, complaint));
  ASSERT_EQ(file.scene.polygons.size(), 5U);
  EXPECT_EQ(file.scene.polygons[0].extrude_m, 120.5);
  for (const std::size_t k : {1U, 2U, 3U, 4U}) EXPECT_EQ(file.scene.polygons[k].extrude_m, 0.0);
}

TEST(GeojsonObjects, StylesAreSimplestyleRadiusAndThroughSurface) {
  const ObjectFile file = good(collection(
      feature(kPoint, R"({"marker-color":"#1E90ff","marker-size":"large","title":"Here","through_surface":true})") +
      "," + feature(kPoint, R"({"radius_m":2500,"marker-color":"0f0"})") + "," +
      feature(geometry("LineString", "[[0,0],[1,1]]"),
              R"({"stroke":"#123456","stroke-width":3.5,"stroke-opacity":0.2})") +
      "," +
      feature(geometry("Polygon", "[[[0,0],[9,0],[9,9],[0,0]]]"),
              R"({"fill":"#010203","fill-opacity":1,"stroke":"#fff","stroke-width":0})")));
  EXPECT_THAT(file.complaints, ElementsAre());
  EXPECT_EQ(file.scene.points[0].color, (ObjectColor{0x1e, 0x90, 0xff}));
  EXPECT_EQ(file.scene.points[0].size_px, 14.0F);
  EXPECT_EQ(file.scene.points[0].radius_m, 0.0);
  EXPECT_TRUE(file.scene.points[0].through_surface);
  EXPECT_EQ(file.scene.points[1].color, (ObjectColor{0, 255, 0}));
  EXPECT_EQ(file.scene.points[1].radius_m, 2500.0);
  EXPECT_FALSE(file.scene.points[1].through_surface);
  EXPECT_EQ(file.scene.lines[0].color, (ObjectColor{0x12, 0x34, 0x56, 51}));
  EXPECT_EQ(file.scene.lines[0].width_px, 3.5F);
  EXPECT_EQ(file.scene.polygons[0].fill, (ObjectColor{1, 2, 3, 255}));
  EXPECT_EQ(file.scene.polygons[0].stroke_width_px, 0.0F);
  ASSERT_EQ(file.scene.labels.size(), 1U);
  EXPECT_EQ(file.scene.labels[0].text, "Here");
}

TEST(GeojsonObjects, WhatIsNotSaidIsAsSimplestyleHasItByDefault) {
  const std::string line = geometry("LineString", "[[0,0],[1,1]]"),
                    area = geometry("Polygon", "[[[0,0],[9,0],[9,9],[0,0]]]");
  const ObjectFile file = good(collection(
      feature(kPoint) + "," + feature(kPoint, "null") + "," + feature(line) + "," + feature(area, R"({"fill":"0f0"})") +
      "," + feature(area, R"({"fill-opacity":0,"stroke-opacity":0.5,"marker-size":null,"title":null})")));
  EXPECT_THAT(file.complaints, ElementsAre());
  const ObjectColor gray{0x55, 0x55, 0x55};
  EXPECT_EQ(file.scene.points[0].color, (ObjectColor{0x7e, 0x7e, 0x7e}));
  EXPECT_EQ(file.scene.points[1].color, file.scene.points[0].color);
  EXPECT_EQ(file.scene.points[0].size_px, 10.0F);
  EXPECT_EQ(file.scene.lines[0].color, gray);
  EXPECT_EQ(file.scene.lines[0].width_px, 2.0F);
  EXPECT_EQ(file.scene.polygons[0].fill, (ObjectColor{0, 255, 0, 153})) << "0.6";
  EXPECT_EQ(file.scene.polygons[0].stroke, gray);
  EXPECT_EQ(file.scene.polygons[0].stroke_width_px, 2.0F);
  EXPECT_EQ(file.scene.polygons[1].fill, (ObjectColor{0x55, 0x55, 0x55, 0}));
  EXPECT_EQ(file.scene.polygons[1].stroke, (ObjectColor{0x55, 0x55, 0x55, 128}));
  EXPECT_THAT(file.scene.labels, ElementsAre());
  EXPECT_EQ(good(kPoint).scene.points[0].color, file.scene.points[0].color) << "a geometry alone";
}

TEST(GeojsonObjects, AMarkersSymbolIsItsLabelIfItIsADigitOrALetterAndThereIsNoTitle) {
  const auto label = [](const char* properties) {
    const ObjectFile file = good(collection(feature(kPoint, properties)));
    EXPECT_THAT(file.complaints, ElementsAre()) << properties;
    return file.scene.labels.empty() ? std::string() : file.scene.labels[0].text;
  };
  EXPECT_EQ(label(R"({"marker-symbol":"a"})"), "a");
  EXPECT_EQ(label(R"({"marker-symbol":"7"})"), "7");
  EXPECT_EQ(label(R"({"marker-symbol":7})"), "7");
  EXPECT_EQ(label(R"({"marker-symbol":"a","title":"","name":"Oslo"})"), "Oslo");
  EXPECT_EQ(label(R"({"marker-symbol":"a","title":"Rome","name":"Oslo"})"), "Rome");
  EXPECT_EQ(label(R"({"marker-symbol":""})"), "");
}

constexpr const char* kRedDot =  // a PNG of one red pixel
    "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR4nGP4z8AAAAMBAQDJ/"
    "pLvAAAAAElFTkSuQmCC";

TEST(GeojsonObjects, AnIconComesFromADataUriOnceForAllItsPoints) {
  const auto with_icon = [](const std::string& more) {
    return feature(kPoint, fmt::format(R"({{"icon":"{}"{}}})", kRedDot, more));
  };
  const ObjectFile file = good(collection(
      with_icon("") + "," +
      with_icon(R"(,"icon-size":24,"icon-anchor":"bottom-left","icon-rotate":30,"icon-color":"#00ff00","title":"t")") +
      "," + with_icon(R"(,"heading_deg":-90)")));
  EXPECT_THAT(file.complaints, ElementsAre());
  ASSERT_EQ(file.scene.points.size(), 3U);
  const PointIcon& first = file.scene.points[0].icon;
  ASSERT_TRUE(first.image);
  EXPECT_EQ(first.image->rgba, (std::vector<std::uint8_t>{255, 0, 0, 255}));
  EXPECT_EQ(file.scene.points[0].size_px, 1.0F) << "the picture's own size";
  EXPECT_EQ(first.anchor, glm::vec2(0.5F, 0.5F));
  EXPECT_EQ(first.tint, (ObjectColor{255, 255, 255}));
  const PointObject& second = file.scene.points[1];
  EXPECT_EQ(second.icon.image, first.image);
  EXPECT_EQ(second.size_px, 24.0F);
  EXPECT_EQ(second.icon.anchor, glm::vec2(0.0F, 1.0F));
  EXPECT_EQ(second.icon.tint, (ObjectColor{0, 255, 0}));
  EXPECT_NEAR(second.icon.heading.deg(), 30.0, 1e-12);
  EXPECT_FALSE(second.icon.from_north);
  EXPECT_TRUE(file.scene.points[2].icon.from_north);
  EXPECT_NEAR(file.scene.points[2].icon.heading.deg(), -90.0, 1e-12);
}

TEST(GeojsonObjects, AnIconThatCannotBeReadIsToldAndADiscIsDrawn) {
  const auto complaints = [](const std::string& properties) {
    const ObjectFile file = good(collection(feature(kPoint, properties)));
    EXPECT_EQ(file.scene.points.size(), 1U) << properties;
    EXPECT_FALSE(file.scene.points.empty() || file.scene.points[0].icon.image) << properties;
    return file.complaints.empty() ? std::string() : file.complaints[0];
  };
  EXPECT_THAT(complaints(R"({"icon":"data:image/png;base64,AAAA"})"),
              AllOf(HasSubstr("feature 1"), HasSubstr("a PNG, JPEG or WebP picture is needed")));
  EXPECT_THAT(complaints(R"({"icon":"data:image/svg+xml,<svg/>"})"), HasSubstr("data:image/png;base64,"));
  EXPECT_THAT(complaints(R"({"icon":"../plane.png"})"), HasSubstr("only files in the same folder"));
  EXPECT_THAT(complaints(R"({"marker-symbol":"bus","name":"Line 7"})"),
              AllOf(HasSubstr("feature 1"), HasSubstr("\"bus\""), HasSubstr("give a picture file as \"icon\"")));
  EXPECT_EQ(complaints(R"({"marker-symbol":""})"), "");
}

TEST(GeojsonObjects, IdsOfTheFeaturesOfSeveralFilesCountOn) {
  const std::string text = collection(feature(kPoint) + "," + feature(kPoint));
  const ObjectFile first = good(text);
  EXPECT_EQ(first.scene.points[1].of.id, ObjectId{2});
  EXPECT_EQ(first.next, ObjectId{3});
  std::istringstream stream(text);
  const auto second = parse_geojson_objects(stream, "g.geojson", {}, first.next);
  ASSERT_TRUE(second);
  EXPECT_EQ(second->scene.points[0].of.id, ObjectId{3});
  EXPECT_EQ(second->next, ObjectId{5});
}

TEST(GeojsonObjects, LinesHaveDashesCasingsAndArrows) {
  const std::string line = geometry("LineString", "[[0,0],[1,1]]");
  const ObjectFile file = good(collection(
      feature(line, R"({"stroke-dasharray":[12,4.5],"casing":"#010203","casing-width":1.5,"stroke-arrows":"end"})") +
      "," + feature(line, "{}")));
  EXPECT_THAT(file.complaints, ElementsAre());
  const LineObject &styled = file.scene.lines[0], &plain = file.scene.lines[1];
  EXPECT_EQ(styled.dashes, (LineDashes{12.0F, 4.5F}));
  EXPECT_EQ(styled.casing, (ObjectColor{1, 2, 3}));
  EXPECT_EQ(styled.casing_px, 1.5F);
  EXPECT_TRUE(styled.arrow_at_end && !styled.arrow_at_start);
  EXPECT_EQ(plain.dashes, LineDashes{});
  EXPECT_FALSE(has_casing(plain) || plain.arrow_at_end || plain.arrow_at_start);
}

TEST(GeojsonObjects, EachSimplestyleValueThatIsWrongIsNamedAndItsDefaultDrawn) {
  for (const char* wrong : {R"("marker-color":"red")",
                            R"("marker-color":"#12345")",
                            R"x("marker-color":"rgb(1,2,3)")x",
                            R"("marker-color":7)",
                            R"("marker-size":"huge")",
                            R"("marker-symbol":12)",
                            R"("marker-symbol":-1)",
                            R"("marker-symbol":[1])",
                            R"("stroke":"")",
                            R"("stroke":"#")",
                            R"("stroke":"#-12345")",
                            R"("stroke-opacity":1.01)",
                            R"("stroke-opacity":"1")",
                            R"("stroke-width":-0.1)",
                            R"("fill":"#ggg")",
                            R"("fill-opacity":-1)",
                            R"("stroke-dasharray":"5 5")",
                            R"("stroke-dasharray":[5])",
                            R"("stroke-dasharray":[5,0])",
                            R"("casing":"no")",
                            R"("casing-width":-1)",
                            R"("stroke-arrows":true)",
                            R"("title":7)",
                            R"("description":{})"}) {
    const std::string name = std::string(wrong).substr(0, std::string(wrong).find(':'));
    const ObjectFile file =
        good(collection(feature(kPoint, "{" + std::string(wrong) + "}") + "," +
                        feature(geometry("Polygon", "[[[0,0],[9,0],[9,9],[0,0]]]"), "{" + std::string(wrong) + "}")));
    EXPECT_THAT(file.complaints,
                ElementsAre(HasSubstr("f.geojson: feature 1: " + name), HasSubstr("f.geojson: feature 2: " + name)));
    ASSERT_TRUE(file.scene.points.size() == 1 && file.scene.polygons.size() == 1) << wrong;
    EXPECT_EQ(file.scene.points[0].color, (ObjectColor{0x7e, 0x7e, 0x7e})) << wrong;
    EXPECT_EQ(file.scene.points[0].size_px, 10.0F) << wrong;
    EXPECT_EQ(file.scene.polygons[0].fill, (ObjectColor{0x55, 0x55, 0x55, 153})) << wrong;
    EXPECT_EQ(file.scene.polygons[0].stroke, (ObjectColor{0x55, 0x55, 0x55})) << wrong;
    EXPECT_EQ(file.scene.polygons[0].stroke_width_px, 2.0F) << wrong;
    EXPECT_THAT(file.scene.labels, ElementsAre()) << wrong;
  }
}

TEST(GeojsonObjects, AStyleThatIsWrongIsComplainedOfAndTheObjectDrawnWithoutIt) {
  const ObjectFile file = good(collection(feature(
      kPoint,
      R"({"name":"Alps","marker-color":"zzz","marker-size":0,"radius_m":-1,"through_surface":"yes","stroke-width":1e9})")));
  EXPECT_EQ(file.scene.points.size(), 1U);
  EXPECT_EQ(file.scene.points[0].color, (ObjectColor{0x7e, 0x7e, 0x7e}));
  ASSERT_EQ(file.complaints.size(), 5U);
  for (const std::string& complaint : file.complaints) {
    EXPECT_THAT(complaint, HasSubstr("f.geojson: feature 1 (\"Alps\"): "));
  }
  EXPECT_THAT(file.complaints[0], HasSubstr("\"marker-color\" is not a colour"));
}

TEST(GeojsonObjects, SomeFeaturesAreShownAtSomeLevelsAndInstants) {
  const auto when = [](const std::string& properties) {
    const ObjectFile file = good(collection(feature(kPoint, properties)));
    EXPECT_THAT(file.complaints, ElementsAre()) << properties;
    return file.shown_when.empty() ? ShownWhen{} : file.shown_when[0];
  };
  const auto at = [](const char* time) { return *parse_utc(time); };
  EXPECT_EQ(when("{}").id, ObjectId::none) << "always";
  EXPECT_EQ(when(R"({"min-zoom":3.5})").id, ObjectId{1});
  EXPECT_EQ(when(R"({"min-zoom":3.5})").from_zoom, 3.5);
  EXPECT_EQ(when(R"({"max-zoom":7})").before_zoom, 7.0);
  EXPECT_EQ(when(R"({"time-begin":"2020"})").from, at("2020-01-01"));
  EXPECT_EQ(when(R"({"time-begin":"2020-07"})").from, at("2020-07-01"));
  EXPECT_EQ(when(R"({"time-end":"2020-07-03T04:05:06Z"})").before, at("2020-07-03T04:05:06Z"));
  EXPECT_EQ(when(R"({"time-end":"2020/07/03 04:05:06+00"})").before, at("2020-07-03T04:05:06Z")) << "as GDAL writes it";
  EXPECT_EQ(when(R"({"time-begin":1234567890000})").from, at("2009-02-13T23:31:30Z"));
}

TEST(GeojsonObjects, LevelsAndInstantsThatAreWrongDoNotHideAFeature) {
  for (const auto& [wrong, says] : std::vector<std::pair<const char*, const char*>>{
           {R"({"min-zoom":25})", "\"min-zoom\" must be a number from 0 to 24"},
           {R"({"max-zoom":"far"})", "\"max-zoom\" must be a number from 0 to 24"},
           {R"({"min-zoom":5,"max-zoom":5})", "\"min-zoom\" must be less than \"max-zoom\""},
           {R"({"time-begin":"yesterday"})", "\"time-begin\" must be an instant"},
           {R"({"time-end":"2020-02-30"})", "\"time-end\" must be an instant"},
           {R"({"time-end":1e300})", "\"time-end\" must be an instant"},
           {R"({"time-begin":"2021","time-end":"2020"})", "\"time-begin\" must be before \"time-end\""}}) {
    const ObjectFile file = good(collection(feature(kPoint, wrong)));
    EXPECT_THAT(file.complaints, ElementsAre(HasSubstr(says))) << wrong;
    EXPECT_THAT(file.shown_when, ElementsAre()) << wrong;
    EXPECT_EQ(file.scene.points.size(), 1U) << wrong;
  }
}

TEST(GeojsonObjects, WhatIsWrongIsLeftOutAndNamedAndTheRestStays) {
  struct Case {
    const char* bad;
    const char* says;
  };
  const Case cases[] = {
      {R"({"type":"Point","coordinates":[8,91]})", "8,91 is not on the planet"},
      {R"({"type":"Point","coordinates":[1e300,0]})", "is not on the planet"},
      {R"({"type":"Point","coordinates":["a",0]})", "not [longitude, latitude]"},
      {R"({"type":"Point","coordinates":[null,0]})", "not [longitude, latitude]"},
      {R"({"type":"Point","coordinates":[0]})", "not [longitude, latitude]"},
      {R"({"type":"Point","coordinates":[0,0,"x"]})", "third coordinate"},
      {R"({"type":"Point","coordinates":[0,0,1e12]})", "height"},
      {R"({"type":"Point"})", "no \"coordinates\""},
      {R"({"type":"LineString","coordinates":[[0,0]]})", "fewer than 2"},
      {R"({"type":"Polygon","coordinates":[]})", "without rings"},
      {R"({"type":"Polygon","coordinates":[[[0,0],[1,1],[0,0]]]})", "ring 1: it has fewer than 4"},
      {R"({"type":"Polygon","coordinates":[[[0,0],[1,0],[1,1],[0,1]]]})", "ring 1: it is not closed: it begins at 0,0"},
      {R"({"type":"Polygon","coordinates":[[[0,0],[180,0],[90,5],[0,0]]]})", "antipodal"},
      {R"({"type":"Circle","coordinates":[0,0]})", "\"Circle\" is not a geometry"},
      {R"({"coordinates":[0,0]})", "no \"type\""},
      {"7", "no \"type\""},
  };
  for (const Case& c : cases) {
    const ObjectFile file = good(collection(feature(kPoint) + "," + feature(c.bad) + "," + feature(kPoint)));
    EXPECT_EQ(file.scene.points.size(), 2U) << c.bad;
    ASSERT_EQ(file.complaints.size(), 1U) << c.bad;
    EXPECT_THAT(file.complaints[0], AllOf(HasSubstr("f.geojson: feature 2: "), HasSubstr(c.says))) << c.bad;
  }
  const ObjectFile parts = good(collection(feature(geometry("MultiPoint", "[[1,2],[3,400],[5,6]]"))));
  EXPECT_EQ(parts.scene.points.size(), 2U);
  EXPECT_THAT(parts.complaints, ElementsAre(HasSubstr("feature 1: part 2: ")));
  const ObjectFile odd = good(collection(feature(kPoint) + R"(,3,[1],{"type":"Point"},)" + feature(kPoint)));
  EXPECT_EQ(odd.scene.points.size(), 2U);
  EXPECT_EQ(odd.complaints.size(), 3U);
}

TEST(GeojsonObjects, ADocumentThatIsNoGeojsonIsAnError) {
  const auto message = [](const std::string& text) {
    const auto file = parsed(text);
    EXPECT_FALSE(file) << text;
    return file ? std::string() : file.error().message;
  };
  EXPECT_THAT(message("<kml/>"), AllOf(HasSubstr("f.geojson: not JSON at byte 1"), HasSubstr("RFC 7946")));
  EXPECT_THAT(message(""), HasSubstr("not JSON"));
  EXPECT_THAT(message("{}"), HasSubstr("no GeoJSON"));
  EXPECT_THAT(message("[1,2]"), HasSubstr("no GeoJSON"));
  EXPECT_THAT(message(R"({"type":"FeatureCollection"})"), HasSubstr("without \"features\""));
  EXPECT_THAT(message(collection(feature("{\"type\":\"Point\",\"coordinates\":[NaN,0]}"))),
              HasSubstr("not JSON at byte"));
  EXPECT_THAT(message(std::string(100'000, '[')), HasSubstr("nested more than 64 deep"));
  const auto missing = read_geojson_objects("no/such/file.geojson");
  ASSERT_FALSE(missing);
  EXPECT_THAT(missing.error().message, HasSubstr("no/such/file.geojson"));
}

TEST(GeojsonObjects, WhatCameBeforeTheTextBreaksOffStays) {
  const std::string whole = collection(feature(kPoint) + "," + feature(kPoint));
  const ObjectFile file = good(whole.substr(0, whole.size() - 20));
  EXPECT_EQ(file.scene.points.size(), 1U);
  EXPECT_THAT(file.complaints, ElementsAre(AllOf(HasSubstr("not JSON at byte"), HasSubstr("the 1 features before"))));
  const ObjectFile large = good(collection(feature(kPoint) + "," + feature(geometry("Point", "[1e999,0]"))));
  EXPECT_EQ(large.scene.points.size(), 1U);
  EXPECT_EQ(large.complaints.size(), 1U);
}

TEST(GeojsonObjects, ComplaintsEndAtAHundred) {
  std::string features = feature(kPoint);
  for (int k = 0; k < 150; ++k) features += "," + feature("3");
  const ObjectFile file = good(collection(features));
  EXPECT_EQ(file.complaints.size(), kMostComplaints);
  EXPECT_EQ(file.complaints_left_out, 50U);
}

TEST(GeojsonObjects, AreasOverTheAntimeridianAndAPoleAreTaken) {
  const ObjectFile file = good(collection(feature(geometry("Polygon", "[[[170,-10],[-170,-10],[-170,10],[170,-10]]]")) +
                                          "," + feature(geometry("Polygon", "[[[0,70],[120,70],[-120,70],[0,70]]]"))));
  EXPECT_THAT(file.complaints, ElementsAre());
  EXPECT_EQ(file.scene.polygons.size(), 2U);
}

// Reading them took the square of their number: minutes for these.
TEST(GeojsonObjects, ManyGeometriesInOneFeatureAreReadInTimeThatGrowsWithTheirNumber) {
  constexpr std::size_t kGeometries = 400'000;
  constexpr double kHang_s = 60.0;  // processor time, which a busy machine does not change; a second or two are taken
  std::string many = kPoint;
  for (std::size_t k = 1; k < kGeometries; ++k) many += "," + kPoint;
  const std::string text = collection(feature(R"({"type":"GeometryCollection","geometries":[)" + many + "]}"));
  const std::clock_t begin = std::clock();
  EXPECT_EQ(good(text).scene.points.size(), kGeometries);
  EXPECT_LT(static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC, kHang_s);
}

TEST(GeojsonObjects, DepthsOfAnEarthquakeCatalogueAreKilometresDown) {
  const std::string metadata =
      R"("metadata":{"url":"https://earthquake.usgs.gov/earthquakes/feed/v1.0/summary/all_week.geojson"},)";
  const std::string quakes = feature(geometry("Point", "[142,38,35]"), R"({"mag":4.0,"title":"M 4.0"})") + "," +
                             feature(geometry("Point", "[-155,19,-2.79]"), R"({"mag":null,"radius_m":7})");
  const ObjectFile file = good(collection(quakes, metadata));
  ASSERT_EQ(file.scene.points.size(), 2U);
  EXPECT_EQ(file.scene.points[0].place.height_m, -35.0e3);
  EXPECT_DOUBLE_EQ(file.scene.points[0].radius_m, 40.0e3);
  EXPECT_EQ(file.scene.points[0].color, (ObjectColor{255, 140, 40}));
  EXPECT_DOUBLE_EQ(file.scene.points[1].place.height_m, 2790.0);
  EXPECT_EQ(file.scene.points[1].radius_m, 7.0);
  EXPECT_TRUE(file.scene.labels.empty());
  EXPECT_EQ(good(collection(quakes)).scene.points[0].place.height_m, 35.0) << "metres, where nothing says otherwise";
}

TEST(GeojsonObjects, TheCatalogueOfAWeekIsAllThere) {
  const auto file = read_geojson_objects(TERRELLA_DATA_FOLDER "/points/earthquakes.geojson");
  ASSERT_TRUE(file) << file.error().message;
  EXPECT_EQ(file->scene.points.size(), 1707U);
  EXPECT_THAT(file->complaints, ElementsAre());
  double deepest_m = 0.0;
  for (const PointObject& point : file->scene.points) deepest_m = std::min(deepest_m, point.place.height_m);
  EXPECT_DOUBLE_EQ(deepest_m, -573'760.0);
}

}  // namespace
}  // namespace terrella
