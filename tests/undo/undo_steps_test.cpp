#include "apps/viewer/undo/undo_steps.h"

#include <gtest/gtest.h>

#include <vector>

#include "apps/viewer/undo/layer_steps.h"

namespace terrella {
namespace {

TEST(UndoSteps, GoBackAndForthTwiceInARow) {
  UndoSteps<int> steps;
  EXPECT_EQ(steps.undo(), nullptr);
  EXPECT_EQ(steps.redo(), nullptr);
  steps.add(1);
  steps.add(2);
  for (int times = 0; times < 2; ++times) {
    for (const int step : {2, 1}) {
      const int* back = steps.undo();
      ASSERT_NE(back, nullptr);
      EXPECT_EQ(*back, step);
    }
    EXPECT_EQ(steps.undo(), nullptr);
    for (const int step : {1, 2}) {
      const int* again = steps.redo();
      ASSERT_NE(again, nullptr);
      EXPECT_EQ(*again, step);
    }
    EXPECT_EQ(steps.redo(), nullptr);
  }
}

TEST(UndoSteps, AStepForgetsThoseThatWereTakenBack) {
  UndoSteps<int> steps;
  for (const int step : {1, 2, 3}) steps.add(step);
  (void)steps.undo();
  (void)steps.undo();
  steps.add(4);
  EXPECT_EQ(steps.redo(), nullptr);
  EXPECT_EQ(*steps.undo(), 4);
  EXPECT_EQ(*steps.undo(), 1);
}

TEST(UndoSteps, TheOldestStepsAreForgotten) {
  constexpr int kMost = static_cast<int>(UndoSteps<int>::kMostSteps);
  UndoSteps<int> steps;
  for (int step = 1; step <= kMost + 5; ++step) steps.add(step);
  int count = 0, last = 0;
  while (const int* step = steps.undo()) {
    last = *step;
    ++count;
  }
  EXPECT_EQ(count, kMost);
  EXPECT_EQ(last, 6);
}

TEST(LayerSteps, AStepHasTheLayersThatChangedAndWereThereBefore) {
  LayerState one{.key = 1, .name = "one"}, two{.key = 2, .name = "two"};
  EXPECT_FALSE(step_between({one, two}, {two, one})) << "the order is no look";
  EXPECT_FALSE(step_between({one}, {one, two})) << "a layer came";
  EXPECT_FALSE(step_between({one, two}, {one})) << "a layer went";
  LayerState faded = two;
  faded.look.opacity = 0.5;
  const auto step = step_between({one, two}, {one, faded});
  ASSERT_TRUE(step);
  EXPECT_EQ(step->before, (std::vector<LayerState>{two}));
  EXPECT_EQ(step->after, (std::vector<LayerState>{faded}));
  EXPECT_EQ(step_text(LayerStep(*step)), "look of two");
}

TEST(LayerSteps, ColourMapAndStyleArePartsOfTheLook) {
  const LayerState plain{.key = 1, .colormap = "viridis", .style = LayerStyle::Drawn{.number = 1}};
  LayerState other = plain;
  other.colormap = "magma";
  EXPECT_TRUE(step_between({plain}, {other}));
  other = plain;
  other.style->number = 2;
  EXPECT_TRUE(step_between({plain}, {other}));
}

}  // namespace
}  // namespace terrella
