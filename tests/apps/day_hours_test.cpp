#include "apps/preload/day_hours.h"

#include <gtest/gtest.h>

namespace terrella {
namespace {

using std::chrono::hours;
using std::chrono::minutes;
using std::chrono::seconds;

seconds wait_at(const std::string& text, seconds moment) {
  const auto parsed = parse_day_hours(text);
  EXPECT_TRUE(parsed);
  return wait_for(*parsed, moment);
}

TEST(DayHours, WaitUntilTheyBegin) {
  EXPECT_EQ(wait_at("09:00-17:30", hours(8)), hours(1));
  EXPECT_EQ(wait_at("09:00-17:30", hours(9)), seconds(0));
  EXPECT_EQ(wait_at("09:00-17:30", hours(17) + minutes(29) + seconds(59)), seconds(0));
  EXPECT_EQ(wait_at("09:00-17:30", hours(17) + minutes(30)), hours(15) + minutes(30));
}

TEST(DayHours, GoOverMidnight) {
  EXPECT_EQ(wait_at("22:00-06:00", hours(23)), seconds(0));
  EXPECT_EQ(wait_at("22:00-06:00", seconds(0)), seconds(0));
  EXPECT_EQ(wait_at("22:00-06:00", hours(6)), hours(16));
  EXPECT_EQ(wait_at("22:00-06:00", hours(22) - seconds(1)), seconds(1));
  EXPECT_EQ(wait_at("22:00-00:00", seconds(0)), hours(22));
}

TEST(DayHours, TakeUtcWithZ) {
  const std::chrono::system_clock::time_point noon{hours(24 * 20000 + 12)};
  EXPECT_EQ(since_midnight(*parse_day_hours("22:00-06:00Z"), noon), hours(12));
  EXPECT_TRUE(parse_day_hours("22:00-06:00Z")->utc);
  EXPECT_FALSE(parse_day_hours("22:00-06:00")->utc);
}

TEST(DayHours, RefuseWhatIsNone) {
  for (const char* text : {"", "22-6", "22:00", "22:00-22:00", "24:00-06:00", "22:60-06:00", "2a:00-06:00",
                           "22:00-06:00z", "22:00-06:00ZZ", "22:00 06:00", "-2:00-06:00"}) {
    EXPECT_FALSE(parse_day_hours(text)) << text;
  }
}

}  // namespace
}  // namespace terrella
