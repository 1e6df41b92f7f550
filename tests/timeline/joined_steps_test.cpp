#include "apps/viewer/timeline/joined_steps.h"

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace terrella {
namespace {

UtcTime at(const char* text) { return *parse_utc(text); }

std::shared_ptr<const TimeSteps> steps(const std::vector<std::string>& values) {
  return std::make_shared<const TimeSteps>(*TimeSteps::parse(values, at("2026-06-21")));
}

/// Days, and months that begin earlier and end later.
JoinedSteps days_and_months() {
  return JoinedSteps({steps({"2020-01-30/2020-02-03/P1D"}), steps({"2020-01-01/2020-03-01/P1M"})});
}

TEST(JoinedStepsTest, AStepIsAnInstantOfAnyLayerOnce) {
  const JoinedSteps all = days_and_months();
  std::vector<std::string> forwards, backwards;
  for (std::optional<UtcTime> step = all.first(); step; step = all.after(*step))
    forwards.push_back(step_text(*step, false));
  for (std::optional<UtcTime> step = all.last(); step; step = all.before(*step))
    backwards.insert(backwards.begin(), step_text(*step, false));
  const std::vector<std::string> expected{"2020-01-01", "2020-01-30", "2020-01-31", "2020-02-01",
                                          "2020-02-02", "2020-02-03", "2020-03-01"};
  EXPECT_EQ(forwards, expected);
  EXPECT_EQ(backwards, expected);
}

TEST(JoinedStepsTest, PlayGoesBothWaysAndRound) {
  const JoinedSteps all = days_and_months();
  const UtcTime first = at("2020-01-01"), last = at("2020-03-01");
  EXPECT_EQ(next_step(all, first, {}), at("2020-01-30"));
  EXPECT_EQ(next_step(all, last, {}), first);
  EXPECT_EQ(next_step(all, last, {.loops = false}), std::nullopt);
  EXPECT_EQ(next_step(all, last, {.backwards = true}), at("2020-02-03"));
  EXPECT_EQ(next_step(all, first, {.backwards = true}), last);
  EXPECT_EQ(next_step(all, first, {.backwards = true, .loops = false}), std::nullopt);
  EXPECT_EQ(next_step(JoinedSteps({steps({"2020-01-01"})}), first, {}), std::nullopt) << "one step alone";
}

TEST(JoinedStepsTest, DaysHaveNoZone) {
  EXPECT_EQ(step_text(at("2020-02-29"), true), "2020-02-29");
  EXPECT_EQ(step_text(at("2020-02-29T06:10Z"), false), "2020-02-29 06:10 UTC");
  EXPECT_EQ(step_text(at("2020-02-29T06:10:05Z"), false), "2020-02-29 06:10:05 UTC");
}

}  // namespace
}  // namespace terrella
