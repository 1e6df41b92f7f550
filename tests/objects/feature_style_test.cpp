#include "streaming/objects/feature_style.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

#include "streaming/objects/geojson_objects.h"
#include "streaming/objects/style_rules.h"

namespace terrella {
namespace {

using nlohmann::json;
using testing::HasSubstr;

FeatureStyle style_of(const std::string& text) {
  auto style = FeatureStyle::parse(text, "s.json");
  EXPECT_TRUE(style) << style.error().message;
  return style ? *std::move(style) : *FeatureStyle::parse("{}", "s.json");
}

/// The value that an expression gives a property.
json value_of(const std::string& expression, const json& fields) {
  return applied(style_of(R"({"title":)" + expression + "}"), fields).at("title");
}

TEST(FeatureStyle, AFieldOrAFixedValueTakesThePlaceOfAProperty) {
  const FeatureStyle style = style_of(R"({"title":["get","city"],"stroke-width":3,"line-color":"#f00"})");
  EXPECT_EQ(applied(style, {{"city", "Bern"}, {"title", "old"}, {"stroke-width", 9}}),
            (json{{"city", "Bern"}, {"title", "Bern"}, {"stroke-width", 3}, {"stroke", "#f00"}}));
  EXPECT_TRUE(applied(style, json()).at("title").is_null()) << "a feature without properties";
}

TEST(FeatureStyle, Categories) {
  const std::string kinds = R"(["match",["get","kind"],"road","#111",["river","lake"],"#00f",7,"#777","#fff"])";
  EXPECT_EQ(value_of(kinds, {{"kind", "road"}}), "#111");
  EXPECT_EQ(value_of(kinds, {{"kind", "lake"}}), "#00f");
  EXPECT_EQ(value_of(kinds, {{"kind", 7}}), "#777");
  EXPECT_EQ(value_of(kinds, {{"kind", "path"}}), "#fff");
  EXPECT_EQ(value_of(kinds, json::object()), "#fff");
}

TEST(FeatureStyle, StepsBeginAtTheirStops) {
  const std::string steps = R"(["step",["get","v"],"low",10,"middle",20,"high"])";
  for (const auto& [value, expected] : std::vector<std::pair<json, json>>{{-1e300, "low"},
                                                                          {9.999, "low"},
                                                                          {10, "middle"},
                                                                          {19.9, "middle"},
                                                                          {20, "high"},
                                                                          {1e300, "high"},
                                                                          {"15", "middle"}}) {
    EXPECT_EQ(value_of(steps, {{"v", value}}), expected) << value;
  }
  EXPECT_TRUE(value_of(steps, {{"v", "many"}}).is_null()) << "no number";
  EXPECT_TRUE(value_of(steps, {{"v", true}}).is_null());
}

TEST(FeatureStyle, NumbersAndColoursBetweenStops) {
  const auto number = [](double v) {
    return value_of(R"(["interpolate",["linear"],["get","v"],0,1,10,3,20,13])", {{"v", v}}).get<double>();
  };
  EXPECT_DOUBLE_EQ(number(-5), 1.0);
  EXPECT_DOUBLE_EQ(number(0), 1.0);
  EXPECT_DOUBLE_EQ(number(5), 2.0);
  EXPECT_DOUBLE_EQ(number(15), 8.0);
  EXPECT_DOUBLE_EQ(number(99), 13.0);
  // MapLibre's definition: (base^(v - low) - 1) / (base^(high - low) - 1), here (4 - 1) / (16 - 1).
  EXPECT_DOUBLE_EQ(value_of(R"(["interpolate",["exponential",2],["get","v"],0,0,4,15])", {{"v", 2}}).get<double>(),
                   3.0);
  const std::string colors = R"(["interpolate",["linear"],["get","v"],0,"#000",1,"#ff8000"])";
  EXPECT_EQ(value_of(colors, {{"v", 0}}), "#000000");
  EXPECT_EQ(value_of(colors, {{"v", 0.5}}), "#804000");
  EXPECT_EQ(value_of(colors, {{"v", 1}}), "#ff8000");
  EXPECT_TRUE(value_of(R"(["interpolate",["linear"],["get","v"],0,"red",1,"#fff"])", {{"v", 0.5}}).is_null());
}

TEST(FeatureStyle, TextsOfSeveralFields) {
  EXPECT_EQ(value_of(R"x(["concat",["get","name"]," (",["get","n"],")"])x", {{"name", "Αθήνα"}, {"n", 3}}),
            "Αθήνα (3)");
  EXPECT_EQ(value_of(R"(["coalesce",["get","name:en"],["get","name"],"?"])", {{"name", "Wien"}}), "Wien");
  EXPECT_EQ(value_of(R"(["coalesce",["get","a"],"?"])", {{"a", nullptr}}), "?");
}

TEST(FeatureStyle, FaultsAreNamedWithACure) {
  const std::vector<std::pair<const char*, const char*>> faults = {
      {"[]", "s.json"},
      {"{", "s.json"},
      {R"({"colour":"#fff"})", "unknown property \"colour\"; there are"},
      {R"({"fill":"#fff","fill-color":"#000"})", "\"fill\" is there twice"},
      {R"({"fill":["zoom"]})", "unknown expression \"zoom\"; there are get"},
      {R"({"fill":["get"]})", "the name of one field"},
      {R"({"fill":["get",["get","a"]]})", "the name of one field"},
      {R"({"fill":["match",["get","a"],"b","#fff"]})", "and a default"},
      {R"({"fill":["step",["get","a"],"#fff",1]})", "pairs of a stop"},
      {R"({"fill":["step",["get","a"],"#fff","1","#000"]})", "must be numbers"},
      {R"({"fill":["interpolate",["cubic"],["get","a"],1,"#fff"]})", "[\"linear\"]"},
      {R"({"fill":["interpolate",["linear"],["get","a"],1,"#fff",1,"#000"]})", "must rise"},
      {R"({"fill":["interpolate",["linear"],["get","a"],1,"#fff",2]})", "pairs of a stop"},
      {R"({"fill":["coalesce",["coalesce",["what"]]]})", "unknown expression \"what\""},
  };
  for (const auto& [text, expected] : faults) {
    const auto style = FeatureStyle::parse(text, "s.json");
    ASSERT_FALSE(style) << text;
    EXPECT_THAT(style.error().message, HasSubstr(expected)) << text;
    EXPECT_THAT(style.error().message, HasSubstr("s.json"));
  }
  const auto missing = FeatureStyle::load("no/such/style.json");
  ASSERT_FALSE(missing);
  EXPECT_THAT(missing.error().message, HasSubstr("no/such/style.json"));
}

constexpr const char* kDistricts = R"({"type":"FeatureCollection","features":[
  {"type":"Feature","properties":{"pop":0,"fill":"#123456"},"geometry":{"type":"Polygon","coordinates":[[[0,0],[1,0],[1,1],[0,0]]]}},
  {"type":"Feature","properties":{"pop":100},"geometry":null},
  {"type":"Feature","properties":{"pop":50},"geometry":{"type":"Polygon","coordinates":[[[2,0],[3,0],[3,1],[2,0]]]}},
  {"type":"Feature","properties":{"name":"Bern","pop":75},"geometry":{"type":"Point","coordinates":[7,47]}},
  {"type":"Feature","properties":{"pop":25},"geometry":{"type":"LineString","coordinates":[[0,0],[5,5]]}}]})";

ObjectFile read(const FeatureStyle& style) {
  std::istringstream text(kDistricts);
  auto file = parse_geojson_objects(text, "f.geojson", {}, ObjectId{1}, style);
  EXPECT_TRUE(file);
  return file ? *std::move(file) : ObjectFile{};
}

const std::string kByPeople = R"({"fill":["interpolate",["linear"],["get","pop"],0,"#000000",100,"#ff0000"],
  "fill-opacity":1,"marker-color":["step",["get","pop"],"#00f",60,"#0f0"],"marker-size":["step",["get","pop"],7,60,75],
  "stroke-width":["match",["get","pop"],25,7,1],"extrude_m":["get","pop"]})";

TEST(FeatureStyle, ObjectsAreReadInAStyle) {
  const FeatureStyle style = style_of(kByPeople);
  const ObjectFile file = read(style);
  EXPECT_TRUE(file.complaints.empty());
  ASSERT_EQ(file.scene.polygons.size(), 2U);
  EXPECT_EQ(file.scene.polygons[0].fill, (ObjectColor{0, 0, 0})) << "in place of its own fill";
  EXPECT_EQ(file.scene.polygons[1].fill, (ObjectColor{128, 0, 0}));
  EXPECT_EQ(file.scene.polygons[1].extrude_m, 50.0);
  EXPECT_EQ(file.scene.points[0].color, (ObjectColor{0, 255, 0}));
  EXPECT_EQ(file.scene.points[0].size_px, 75.0F);
  EXPECT_EQ(file.scene.lines[0].width_px, 7.0F);
  EXPECT_EQ(file.scene.polygons[0].of.feature->properties, R"({"fill":"#123456","pop":0})")
      << "a pick tells the fields";
}

/// The truth is the file read again in the other style.
TEST(FeatureStyle, AnotherStyleByEditsIsThatOfReadingAgain) {
  const FeatureStyle style = style_of(kByPeople);
  const ObjectFile again = read(style);
  const auto edits = restyled(features_of(read({}).scene), style);
  ASSERT_EQ(edits.changes.size(), 4U);
  EXPECT_EQ(edits.changes[0].fill, again.scene.polygons[0].fill);
  EXPECT_EQ(edits.changes[1].id, ObjectId{3});
  EXPECT_EQ(edits.changes[1].fill, again.scene.polygons[1].fill);
  EXPECT_EQ(edits.changes[1].color, again.scene.polygons[1].stroke);
  EXPECT_EQ(edits.changes[2].color, again.scene.points[0].color);
  EXPECT_EQ(edits.changes[2].size_px, again.scene.points[0].size_px);
  EXPECT_EQ(edits.changes[2].label, again.scene.labels[0].color);
  EXPECT_EQ(edits.changes[3].size_px, again.scene.lines[0].width_px);
  ASSERT_EQ(edits.texts.size(), 1U);
  EXPECT_EQ(edits.texts[0].text, "Bern");
}

TEST(FeatureStyle, TextsHaveSizesColoursHalosAnchorsAndSpacing) {
  const FeatureStyle style = style_of(R"({"text-size":["step",["get","pop"],10,60,31.5],"text-color":"#123456",
    "text-halo-color":"#fff","text-halo-width":2.5,"text-anchor":"bottom-right","text-letter-spacing":0.2,
    "text-font":["Noto Sans Light Oblique","Arial Bold"],"text-halo-blur":1.2})");
  const ObjectFile file = read(style);
  EXPECT_TRUE(file.complaints.empty());
  const LabelObject& label = file.scene.labels.at(0);
  EXPECT_EQ(label.color, (ObjectColor{0x12, 0x34, 0x56}));
  EXPECT_EQ(label.look,
            (LabelLook{31.5F, {255, 255, 255}, 2.5F, TextAnchor::bottom_right, 0.2F, TextWeight::light, true, 1.2F}));
  const ObjectFile plain = read({});
  EXPECT_EQ(plain.scene.labels.at(0).look, LabelLook{});
  const ObjectChange change = restyled(features_of(plain.scene), style).changes.at(2);
  EXPECT_EQ(change.look, label.look);
  EXPECT_EQ(change.label, label.color);
  const ObjectFile faulty = read(style_of(R"({"text-size":5,"text-color":"ink","text-halo-color":1,"text-halo-width":9,
    "text-anchor":"middle","text-letter-spacing":-0.1,"text-font":7,"text-halo-blur":-1})"));
  EXPECT_EQ(faulty.scene.labels.at(0).look, LabelLook{});
  for (const char* cure :
       {"\"text-size\" must be a number from 6 to 64", "\"text-color\" is not a colour",
        "\"text-halo-color\" is not a colour", "\"text-halo-width\" must be a number from 0 to 8",
        "\"text-anchor\" must be center, left", "\"text-letter-spacing\" must be a number from 0 to 1",
        "\"text-font\" must be a font's name, such as Noto Sans Bold",
        "\"text-halo-blur\" must be a number from 0 to 8"}) {
    EXPECT_THAT(faulty.complaints, testing::Contains(HasSubstr(cure)));
  }
}

TEST(FeatureStyle, NamesOfFontsHaveWeightsAndSlants) {
  const auto look = [](const std::string& font) {
    const LabelLook read_look = read(style_of(R"({"text-font":)" + font + "}")).scene.labels.at(0).look;
    return std::pair{read_look.weight, read_look.slanted};
  };
  EXPECT_EQ(look(R"("Open Sans Bold")"), std::pair(TextWeight::bold, false));
  EXPECT_EQ(look(R"(["match",["get","pop"],75,"Sans Semibold Italic","Sans"])"), std::pair(TextWeight::bold, true));
  EXPECT_EQ(look(R"(["Roboto Thin"])"), std::pair(TextWeight::light, false));
  EXPECT_EQ(look(R"("Inter ExtraLight")"), std::pair(TextWeight::light, false));
  EXPECT_EQ(look(R"("Sans-BoldItalic")"), std::pair(TextWeight::bold, true));
  for (const char* plain : {R"("DejaVu Sans")", R"("Highlight Sans")", R"("Blackadder")"}) {
    EXPECT_EQ(look(plain), std::pair(TextWeight::regular, false)) << plain;
  }
  EXPECT_FALSE(FeatureStyle::parse(R"({"text-font":["sum",1]})", "style"));
}

TEST(FeatureStyle, ValuesBelongToTheFeaturesOfTheirNumbers) {
  const FeatureStyle style = style_of(R"({"fill":["interpolate",["linear"],["get","value"],0,"#000000",1,"#ffffff"]})");
  const std::vector<double> values = {0.2, 1.0, 0.4, 0.0, std::numeric_limits<double>::quiet_NaN()};
  const auto edits = restyled(features_of(read({}).scene), style, values);
  EXPECT_EQ(edits.changes[0].fill->red, 51);
  EXPECT_EQ(edits.changes[1].fill->red, 102) << "the second feature has no place, and its value is nobody's";
  const auto none = restyled(features_of(read({}).scene), style);
  EXPECT_EQ(none.changes[0].fill->red, 0x55) << "no value: simplestyle's default";
}

TEST(FeatureStyle, AWidthOfNothingHidesALine) {
  const auto edits = restyled(features_of(read({}).scene), style_of(R"({"stroke-width":0})"));
  EXPECT_EQ(edits.changes[3].color->alpha, 0);
  EXPECT_FALSE(edits.changes[3].size_px);
}

TEST(FeatureStyle, AnotherStyleShowsFeaturesAtOtherLevels) {
  std::istringstream text(R"({"type":"FeatureCollection","features":[
      {"type":"Feature","properties":{"rank":2,"min-zoom":9},"geometry":{"type":"Point","coordinates":[0,0]}},
      {"type":"Feature","properties":{"rank":5},"geometry":{"type":"Point","coordinates":[1,0]}}]})");
  const std::vector<FeatureParts> parts = features_of(parse_geojson_objects(text, "z.geojson")->scene);
  const auto levels = [&parts](const FeatureStyle& style, std::span<const double> values = {}) {
    std::vector<std::pair<ObjectId, double>> all;
    for (const ShownWhen& when : shown_when(parts, style, values)) all.emplace_back(when.id, when.from_zoom);
    return all;
  };
  using testing::ElementsAre;
  using testing::Pair;
  EXPECT_THAT(levels({}), ElementsAre(Pair(ObjectId{1}, 9.0))) << "by its own properties";
  EXPECT_THAT(levels(style_of(R"({"marker-color":"#f00"})")), ElementsAre(Pair(ObjectId{1}, 9.0)));
  EXPECT_THAT(levels(style_of(R"({"minzoom":["get","rank"]})")),
              ElementsAre(Pair(ObjectId{1}, 2.0), Pair(ObjectId{2}, 5.0)));
  EXPECT_THAT(levels(style_of(R"({"min-zoom":["get","value"]})"), std::vector<double>{0.0, 7.0}),
              ElementsAre(Pair(ObjectId{2}, 7.0)));
}

}  // namespace
}  // namespace terrella
