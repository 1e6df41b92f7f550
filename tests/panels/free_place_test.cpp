#include "apps/viewer/panels/free_place.h"

#include <gtest/gtest.h>

#include <vector>

namespace terrella {
namespace {

TEST(FreePlace, TheLongestStretchBetweenBoxes) {
  const std::vector<UiBox> taken{{0, 0, 50, 20}, {40, 70, 90, 80}, {200, 0, 300, 100}};
  const auto free = [&](UiSpan across) { return free_height(across, {0, 100}, taken); };
  EXPECT_EQ(free({100, 150}).length(), 100.0);
  EXPECT_EQ(free({45, 60}).from, 20.0);
  EXPECT_EQ(free({45, 60}).to, 70.0);
  EXPECT_EQ(free({60, 70}).from, 0.0);
  EXPECT_EQ(free({250, 260}).length(), 0.0);
  EXPECT_EQ(free({90, 100}).length(), 100.0) << "boxes that touch do not overlap";
}

TEST(FreePlace, OverlappingBoxesCountOnce) {
  const std::vector<UiBox> taken{{0, 10, 50, 60}, {0, 20, 50, 30}, {0, 90, 50, 200}};
  const UiSpan free = free_height({0, 10}, {0, 100}, taken);
  EXPECT_EQ(free.from, 60.0);
  EXPECT_EQ(free.to, 90.0);
}

TEST(FreePlace, TheFirstCandidateWithoutABoxInTheWindow) {
  const std::vector<UiBox> taken{{0, 0, 50, 50}};
  const std::vector<UiBox> candidates{{40, 40, 60, 60}, {90, 90, 110, 110}, {60, 60, 80, 80}, {70, 70, 80, 80}};
  EXPECT_EQ(first_free(candidates, {0, 0, 100, 100}, taken), &candidates[2]);
  EXPECT_EQ(first_free(candidates, {0, 0, 55, 55}, taken), nullptr);
}

}  // namespace
}  // namespace terrella
