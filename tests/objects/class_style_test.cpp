// Styles of classes, from the fields of features to colours.

#include "streaming/objects/classes/class_style.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "streaming/objects/classes/field_values.h"
#include "streaming/objects/style_rules.h"

namespace terrella {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::IsEmpty;

constexpr ObjectColor kLow{10, 20, 30}, kMiddle{255, 0, 1}, kHigh{0, 0, 0};

std::vector<FeatureParts> features(const std::vector<json>& fields) {
  std::vector<FeatureParts> all;
  all.reserve(fields.size());
  for (std::size_t k = 0; k < fields.size(); ++k) {
    auto feature = std::make_shared<ObjectFeature>(ObjectFeature{.properties = fields[k].dump()});
    all.push_back({.of = {.id = ObjectId{k + 1}, .feature = std::move(feature)}, .has_area = true});
  }
  return all;
}

FeatureStyle parsed(const std::string& text) {
  auto style = FeatureStyle::parse(text, "s.json");
  EXPECT_TRUE(style) << style.error().message << "\n" << text;
  return style ? *std::move(style) : FeatureStyle();
}

json fill(const FeatureStyle& style, const json& fields) { return applied(style, fields).value("fill", json()); }

TEST(Fields, HaveTheirTypeTheirValuesAndACountOfThoseWithout) {
  const auto fields = fields_of(features({{{"people", 3}, {"name", "a"}, {"code", "07"}, {"list", {1, 2}}},
                                          {{"people", 1.5}, {"name", "b"}, {"code", " 8 "}},
                                          {{"people", nullptr}, {"name", "b"}, {"code", ""}},
                                          {{"name", 5}, {"open", true}}}));
  ASSERT_EQ(fields.size(), 4U) << "lists are left out";
  const FieldValues &code = fields[0], &name = fields[1], &open = fields[2], &people = fields[3];
  EXPECT_EQ(code.name, "code");
  EXPECT_TRUE(code.is_numeric) << "texts that are numbers";
  EXPECT_THAT(code.numbers, ElementsAre(7.0, 8.0));
  EXPECT_EQ(code.missing, 2U) << "an empty text is no value";
  EXPECT_FALSE(name.is_numeric);
  EXPECT_THAT(name.categories,
              ElementsAre(FieldCategory{"\"b\"", 2}, FieldCategory{"\"a\"", 1}, FieldCategory{"5", 1}));
  EXPECT_EQ(name.missing, 0U);
  EXPECT_THAT(open.categories, ElementsAre(FieldCategory{"true", 1}));
  EXPECT_FALSE(open.is_numeric);
  EXPECT_TRUE(people.is_numeric);
  EXPECT_THAT(people.numbers, ElementsAre(3.0, 1.5));
  EXPECT_EQ(people.missing, 2U);
}

TEST(Fields, OfFeaturesWithoutPropertiesAreNone) {
  auto bare = features({json::object(), json::array({1})});
  bare.push_back({.of = {.id = ObjectId{9}}});
  EXPECT_THAT(fields_of(bare), IsEmpty());
}

TEST(Fields, KeepABoundedNumberOfCategories) {
  std::vector<json> many;
  many.reserve(kMostCategories + 50);
  for (std::size_t k = 0; k < kMostCategories + 50; ++k) many.push_back({{"id", "n" + std::to_string(k)}});
  const auto fields = fields_of(features(many));
  ASSERT_EQ(fields.size(), 1U);
  EXPECT_EQ(fields[0].categories.size(), kMostCategories);
}

TEST(ClassStyleText, GivesNumbersTheColourOfTheirClass) {
  const ClassStyle style{.field = "people",
                         .stops = {10.0, 20.5},
                         .colors = {kLow, kMiddle, kHigh},
                         .rest = kRestColor,
                         .targets = {.fill = true}};
  const FeatureStyle read = parsed(style_text(style));
  EXPECT_EQ(fill(read, {{"people", -5}}), "#0a141e");
  EXPECT_EQ(fill(read, {{"people", 9.999}}), "#0a141e");
  EXPECT_EQ(fill(read, {{"people", 10}}), "#ff0001");
  EXPECT_EQ(fill(read, {{"people", "20.5"}}), "#000000");
  EXPECT_EQ(fill(read, {{"people", nullptr}}), "#8a8a8a");
  EXPECT_EQ(fill(read, json::object()), "#8a8a8a");
  EXPECT_TRUE(applied(read, {{"people", 1}}).value("stroke", json()).is_null()) << "only the targets";
}

TEST(ClassStyleText, GivesTextsTheColourOfTheirCategory) {
  const ClassStyle style{.field = "kind",
                         .categories = {"\"wood \\\"x\\\"\"", "7", "true"},
                         .colors = {kLow, kMiddle, kHigh},
                         .rest = kRestColor,
                         .targets = {.fill = true, .stroke = true, .marker = true}};
  const FeatureStyle read = parsed(style_text(style));
  EXPECT_EQ(fill(read, {{"kind", "wood \"x\""}}), "#0a141e");
  EXPECT_EQ(fill(read, {{"kind", 7}}), "#ff0001");
  EXPECT_EQ(fill(read, {{"kind", true}}), "#000000");
  EXPECT_EQ(fill(read, {{"kind", "7"}}), "#8a8a8a");
  EXPECT_EQ(fill(read, json::object()), "#8a8a8a");
  const json all = applied(read, {{"kind", 7}});
  EXPECT_EQ(all.at("stroke"), "#ff0001");
  EXPECT_EQ(all.at("marker-color"), "#ff0001");
}

TEST(ClassStyleText, IsReadBackAsTheSameClasses) {
  const ClassStyle numbers{
      .field = "n", .stops = {0.1, 1e300}, .colors = {kLow, kMiddle, kHigh}, .targets = {.fill = true, .marker = true}};
  ClassStyle with_rest = numbers;
  with_rest.rest = kMiddle;
  const ClassStyle one{.field = "n", .colors = {kLow}, .targets = {.stroke = true}};
  const ClassStyle texts{.field = "Straße",
                         .categories = {"\"a\"", "false"},
                         .colors = {kHigh, kLow},
                         .rest = kMiddle,
                         .targets = {.icon = true}};
  for (const ClassStyle& style : {numbers, with_rest, one, texts}) {
    const auto read = classes_of(parsed(style_text(style)));
    ASSERT_TRUE(read) << style_text(style);
    EXPECT_EQ(*read, style) << style_text(style);
  }
}

TEST(Classes, OfOtherStylesAreNone) {
  EXPECT_FALSE(classes_of({}));
  for (const char* text :
       {R"({"fill":"#fff"})", R"({"fill":["interpolate",["linear"],["get","n"],0,"#000",1,"#fff"]})",
        R"({"stroke-width":["step",["get","n"],1,5,2]})",
        R"({"fill":["step",["coalesce",["get","n"],3],"#000",1,"#fff"]})",
        R"({"fill":["match",["get","n"],1,["get","color"],"#fff"]})",
        R"({"fill":["match",["get","n"],1,"#fff","red"]})", R"({"fill":["coalesce",["get","n"],"#fff"]})"}) {
    EXPECT_FALSE(classes_of(parsed(text))) << text;
  }
}

TEST(Overlaid, KeepsTheOtherPropertiesOfAStyle) {
  const FeatureStyle base = parsed(R"({"stroke-width":3,"fill-color":"#fff"})");
  const auto both = overlaid(base, R"({"fill":"#000"})");
  ASSERT_TRUE(both) << both.error().message;
  EXPECT_EQ(applied(*both, json::object()), (json{{"stroke-width", 3}, {"fill", "#000"}}));
  EXPECT_EQ(json::parse(style_text(*both)), (json{{"stroke-width", 3}, {"fill", "#000"}}));
  EXPECT_EQ(json::parse(style_text(FeatureStyle())), json::object());
}

TEST(Targets, AreTheKindsOfTheFeatures) {
  std::vector<FeatureParts> parts(2);
  parts[0].has_area = true;
  EXPECT_EQ(targets_of(parts), (StyleTargets{.fill = true})) << "areas alone keep their edges";
  parts[1].has_line = true;
  EXPECT_EQ(targets_of(parts), (StyleTargets{.fill = true, .stroke = true}));
  parts[0].has_point = parts[0].has_icon = true;
  EXPECT_TRUE(targets_of(parts).icon);
  EXPECT_FALSE(targets_of(parts).marker);
}

}  // namespace
}  // namespace terrella
