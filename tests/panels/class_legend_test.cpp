#include "apps/viewer/styles/class_legend.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "apps/viewer/panels/legend.h"
#include "apps/viewer/styles/style_choice.h"
#include "panel_screen.h"
#include "streaming/objects/classes/class_breaks.h"

namespace terrella {
namespace {

using test::Screen;
using testing::ElementsAre;

std::vector<std::string> texts_of(const LegendItem& item) {
  std::vector<std::string> texts;
  texts.reserve(item.classes.size());
  for (const LegendClass& one : item.classes) texts.push_back(one.text);
  return texts;
}

TEST(StopTexts, HaveFewDecimalsAndTellClassesApart) {
  EXPECT_THAT(stop_texts(std::vector{10.0, 20.0}), ElementsAre("10", "20"));
  EXPECT_THAT(stop_texts(std::vector{0.5, 1.0}), ElementsAre("0.5", "1.0"));
  EXPECT_THAT(stop_texts(std::vector{1.0 / 3.0, 2.0 / 3.0}), ElementsAre("0.33", "0.67"));
  EXPECT_THAT(stop_texts(std::vector{123456.789, 654321.123}), ElementsAre("123457", "654321"));
  EXPECT_THAT(stop_texts(std::vector{1000.001, 1000.002}), ElementsAre("1000.001", "1000.002"));
  EXPECT_THAT(stop_texts(std::vector{-12.25}), ElementsAre("-12"));
  EXPECT_THAT(stop_texts(std::vector{2e20, 3e20}), ElementsAre("2e+20", "3e+20"));
  EXPECT_TRUE(stop_texts({}).empty());
}

TEST(ClassLegend, HasARangeForEachClass) {
  const ClassStyle style{
      .field = "people", .stops = {10.0, 25.0}, .colors = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}}, .rest = kRestColor};
  const LegendItem item = class_legend("districts", style);
  EXPECT_EQ(item.title, "people (districts)");
  EXPECT_THAT(texts_of(item), ElementsAre("under 10", "10 to 25", "25 and over", "no value"));
  EXPECT_EQ(item.classes[1].color, (Rgba8{4, 5, 6, 255}));
}

TEST(ClassLegend, HasTheTextsOfCategories) {
  const ClassStyle style{.field = "kind",
                         .categories = {"\"wood\"", "7", R"(["a","b"])"},
                         .colors = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}},
                         .rest = kRestColor};
  EXPECT_THAT(texts_of(class_legend("land", style)), ElementsAre("wood", "7", "a, b", "other"));
}

TEST(ClassColors, AreEvenAndReachBothEnds) {
  EXPECT_THAT(class_colors("grey", 3, false),
              ElementsAre(ObjectColor{0, 0, 0}, ObjectColor{128, 128, 128}, ObjectColor{255, 255, 255}));
  EXPECT_THAT(class_colors("grey", 2, true), ElementsAre(ObjectColor{255, 255, 255}, ObjectColor{0, 0, 0}));
  EXPECT_EQ(class_colors("viridis", 1, false).size(), 1U);
}

TEST(StyleOfAChoice, HasClassesOfNumbersAndCategoriesOfTexts) {
  const FieldValues numbers{.name = "n", .numbers = {1, 2, 9, 10}, .categories = {{"1", 1}}, .missing = 1};
  const StyleChoice jenks{.field = "n", .kind = StyleClasses::jenks, .colormap = "grey", .classes = 2};
  const ClassStyle classes = style_of(jenks, numbers, {.fill = true});
  EXPECT_THAT(classes.stops, ElementsAre(9.0));
  EXPECT_EQ(classes.rest, kRestColor) << "a feature has no value";
  const FieldValues texts{.name = "t", .is_numeric = false, .categories = {{"\"a\"", 5}, {"\"b\"", 2}, {"\"c\"", 1}}};
  const ClassStyle kinds = style_of(jenks, texts, {.fill = true});
  EXPECT_THAT(kinds.categories, ElementsAre("\"a\"", "\"b\"")) << "the most frequent ones";
  EXPECT_EQ(kinds.rest, kRestColor);
}

class LegendRoom : public test::PanelScreen {};

TEST_P(LegendRoom, AnItemWithoutRoomIsLeftOut) {
  LegendItem classes{.title = "classes", .unit = {}, .look = {}};
  classes.classes.assign(static_cast<std::size_t>(kMostClasses) + 1, {{}, "under 10"});
  const std::vector<LegendItem> items(4, classes);
  ImGui::NewFrame();
  const double bottom = window_height() - 40.0;
  const auto shown = legend_with_room(items, 12.0, bottom);
  EXPECT_LT(shown.size(), items.size());
  EXPECT_GE(legend_box(shown, 12.0, bottom).top, 0.0);
  draw_legend(shown, 12.0, bottom);
  const std::vector<UiBox> boxes = Ui::panel_boxes();
  ASSERT_EQ(boxes.size(), shown.empty() ? 0U : 1U);
  for (const UiBox& box : boxes) EXPECT_NEAR(box.top, legend_box(shown, 12.0, bottom).top, 1.0) << "whole pixels";
  ImGui::EndFrame();
}

INSTANTIATE_TEST_SUITE_P(Sizes, LegendRoom,
                         testing::Values(Screen{200, 150, 1}, Screen{640, 480, 1}, Screen{640, 480, 2},
                                         Screen{1280, 800, 1}));

}  // namespace
}  // namespace terrella
