#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "streaming/numbers/number_statistics.h"
#include "streaming/numbers/stretch_rule.h"

namespace terrella::test {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

/// 0 to 1000, each once, in an order of no meaning, and 100 pixels without data.
std::vector<float> ramp() {
  std::vector<float> numbers(100, kNone);
  for (int i = 0; i <= 1000; ++i) numbers.push_back(static_cast<float>(i * 373 % 1001));
  return numbers;
}

TEST(NumberStatisticsTest, SumsUpWithoutNoData) {
  const NumberStatistics s = statistics_of(ramp());
  EXPECT_EQ(s.known, 1001U);
  EXPECT_EQ(s.unknown, 100U);
  EXPECT_EQ(s.min, 0.0);
  EXPECT_EQ(s.max, 1000.0);
  EXPECT_NEAR(s.mean, 500.0, 1e-9);
  // Variance of 0 … n: n(n + 2)/12.
  EXPECT_NEAR(s.sigma, std::sqrt(1000.0 * 1002.0 / 12.0), 1e-9);
  EXPECT_DOUBLE_EQ(s.percentile(2.0), 20.0);
  EXPECT_DOUBLE_EQ(s.percentile(97.55), 975.5);
  std::size_t all = 0;
  for (const std::uint32_t bin : s.bins) {
    EXPECT_NEAR(bin, 1001.0 / 256.0, 1.0);
    all += bin;
  }
  EXPECT_EQ(all, 1001U);
}

TEST(NumberStatisticsTest, ScaleAndOffsetApplyToValuesAndMayTurnTheirOrder) {
  const NumberStatistics s = statistics_of(ramp(), -0.5, 10.0);
  EXPECT_EQ(s.min, -490.0);
  EXPECT_EQ(s.max, 10.0);
  EXPECT_NEAR(s.mean, -240.0, 1e-9);
  EXPECT_DOUBLE_EQ(s.percentile(0.0), -490.0);
  EXPECT_DOUBLE_EQ(s.percentile(100.0), 10.0);
}

TEST(NumberStatisticsTest, NothingAndOneValueAreNoFault) {
  const NumberStatistics none = statistics_of({kNone, std::numeric_limits<float>::infinity()});
  EXPECT_EQ(none.known, 0U);
  EXPECT_EQ(none.unknown, 2U);
  const NumberStatistics one = statistics_of({7.0F, 7.0F});
  EXPECT_EQ(one.min, 7.0);
  EXPECT_EQ(one.sigma, 0.0);
  EXPECT_EQ(one.bins[0], 2U);
  const Stretch around = stretch_by(StretchRule{}, one);
  EXPECT_LT(around.low, 7.0);
  EXPECT_GT(around.high, 7.0);
}

TEST(StretchRuleTest, EveryFormIsReadAndWritten) {
  const NumberStatistics s = statistics_of(ramp());
  const auto range = [&s](const char* text) {
    const auto rule = parse_stretch(text);
    EXPECT_TRUE(rule) << text;
    const auto again = parse_stretch(stretch_text(*rule));
    EXPECT_TRUE(again && *again == *rule) << text << " becomes " << stretch_text(*rule);
    return stretch_by(*rule, s);
  };
  const auto expect = [&range](const char* text, double low, double high) {
    const Stretch is = range(text);
    EXPECT_NEAR(is.low, low, 1e-9) << text;
    EXPECT_NEAR(is.high, high, 1e-9) << text;
  };
  expect("-1.5,2e3", -1.5, 2000.0);
  expect("minmax", 0.0, 1000.0);
  expect("percent:1,90", 10.0, 900.0);
  expect("2-98", 20.0, 980.0);
  expect("auto", 20.0, 980.0);
  expect("sigma:1", 500.0 - s.sigma, 500.0 + s.sigma);
}

TEST(StretchRuleTest, OtherTextIsRefusedWithWhatIsAccepted) {
  for (const char* text : {"", "5", "2,1", "1,1", "percent:2", "percent:98,2", "percent:-1,50", "2-101", "sigma:0",
                           "sigma:-1", "sigma", "1,nan", "minmax,2", "1,2,3"}) {
    const auto rule = parse_stretch(text);
    ASSERT_FALSE(rule) << text;
    EXPECT_NE(rule.error().message.find("percent:2,98"), std::string::npos) << rule.error().message;
  }
}

}  // namespace
}  // namespace terrella::test
