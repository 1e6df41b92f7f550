// Class breaks against definitions written apart: all partitions of a few numbers, and quantiles by sorting.

#include "streaming/objects/classes/class_breaks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <set>
#include <string>
#include <vector>

namespace terrella {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::IsEmpty;
using Values = std::vector<double>;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kSumSlack = 1e-9;  // relative, for sums of squares of some hundred values

/// The sum of squared distances of numbers from the means of their classes, class by class.
double sum_of(const Values& values, const Values& stops) {
  double sum = 0.0;
  for (std::size_t k = 0; k <= stops.size(); ++k) {
    Values mine;
    for (const double value : values) {
      const bool from = k == 0 || value >= stops[k - 1], under = k == stops.size() || value < stops[k];
      if (from && under) mine.push_back(value);
    }
    const double mean = std::accumulate(mine.begin(), mine.end(), 0.0) / static_cast<double>(mine.size());
    for (const double value : mine) sum += (value - mean) * (value - mean);
  }
  return sum;
}

/// The least sum over all ways to choose `more` further stops among different values from `next` on.
double least_sum(const Values& values, const Values& different, std::size_t next, std::size_t more, Values stops) {
  if (more == 0) return sum_of(values, stops);
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = next; k + more <= different.size(); ++k) {
    Values longer = stops;
    longer.push_back(different[k]);
    least = std::min(least, least_sum(values, different, k + 1, more - 1, longer));
  }
  return least;
}

Values random_values(std::mt19937& random, std::size_t count, int kind) {
  std::uniform_real_distribution<double> share(0.0, 1.0);
  std::uniform_int_distribution<int> few(-3, 9);
  Values values(count);
  for (double& value : values) {
    value = kind == 0 ? share(random) : kind == 1 ? few(random) : std::exp(12.0 * share(random)) - 1e5;
  }
  return values;
}

TEST(JenksBreaks, AreAsGoodAsTheBestOfAllPartitions) {
  std::mt19937 random(20117);
  for (int round = 0; round < 150; ++round) {
    const Values values = random_values(random, 3 + static_cast<std::size_t>(round % 10), round % 3);
    const std::set<double> set(values.begin(), values.end());
    const Values different(set.begin(), set.end());
    for (std::size_t classes = 2; classes <= std::min<std::size_t>(5, different.size()); ++classes) {
      const ClassBreaks breaks = class_breaks(values, ClassKind::jenks, static_cast<int>(classes));
      ASSERT_EQ(breaks.stops.size(), classes - 1);
      const double best = least_sum(values, different, 1, classes - 1, {});
      const double slack = kSumSlack * sum_of(values, {});
      EXPECT_THAT(sum_of(values, breaks.stops), DoubleNear(best, slack)) << "round " << round << ", " << classes;
    }
  }
}

TEST(JenksBreaks, LieBetweenTheGroupsOfValues) {
  const Values values{1, 2, 3, 50, 51, 52, 53, 400, 401};
  EXPECT_THAT(class_breaks(values, ClassKind::jenks, 3).stops, ElementsAre(50, 400));
  EXPECT_THAT(class_breaks(values, ClassKind::jenks, 3).counts, ElementsAre(3, 4, 2));
}

// A large number added to all values, or a factor, moves the breaks and no value to another class.
TEST(JenksBreaks, KeepTheirClassesFarFromZeroAndAtTheEndsOfTheRangeOfNumbers) {
  const Values values{0, 1, 2, 10, 11, 12, 13, 30, 31};
  for (const auto& [factor, more] : std::vector<std::pair<double, double>>{
           {1.0, 1e12}, {1.0, -1e12}, {1e-300, 0.0}, {5e306, 0.0}, {5.5e306, -0.8e308}}) {
    Values moved = values;
    for (double& value : moved) value = value * factor + more;
    EXPECT_THAT(class_breaks(moved, ClassKind::jenks, 3).counts, ElementsAre(3, 4, 2)) << factor << " " << more;
  }
}

TEST(JenksBreaks, OfManyValuesTakeLittleTime) {
  std::mt19937 random(5);
  const Values values = random_values(random, 200'000, 2);
  const auto start = std::chrono::steady_clock::now();
  const ClassBreaks breaks = class_breaks(values, ClassKind::jenks, kMostClasses);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  EXPECT_EQ(breaks.stops.size(), static_cast<std::size_t>(kMostClasses) - 1);
  EXPECT_LT(took.count(), 20.0) << "seconds; 0.2 on one idle core";
  // Breaks between groups of ten values are hardly worse than those of a sample of the values.
  EXPECT_LE(sum_of(values, breaks.stops), sum_of(values, class_breaks(values, ClassKind::quantile, 9).stops));
}

TEST(EqualBreaks, HaveTheSameWidth) {
  const ClassBreaks breaks = class_breaks(Values{10, 0, 1, 2, 3}, ClassKind::equal, 4);
  EXPECT_THAT(breaks.stops, ElementsAre(2.5, 5.0, 7.5));
  EXPECT_THAT(breaks.counts, ElementsAre(3, 1, 0, 1));
  const ClassBreaks wide = class_breaks(Values{-1.5e308, 0.0, 1.5e308}, ClassKind::equal, 2);
  EXPECT_THAT(wide.stops, ElementsAre(0.0)) << "the range is no finite number";
}

// numpy.quantile(values, k / classes), by its definition; then the least value that is not under it.
TEST(QuantileBreaks, AreValuesAtTheQuantilesOfType7) {
  std::mt19937 random(77);
  for (int round = 0; round < 60; ++round) {
    Values values = random_values(random, 1 + static_cast<std::size_t>(round), round % 3);
    Values sorted = values;
    std::ranges::sort(sorted);
    const std::size_t different = std::set<double>(values.begin(), values.end()).size();
    for (std::size_t classes = 2; classes <= 7; ++classes) {
      std::set<double> expected;
      const std::size_t most = std::min(classes, different);
      for (std::size_t k = 1; k < most; ++k) {
        const double place = static_cast<double>(k * (sorted.size() - 1)) / static_cast<double>(most);
        const double low = sorted[static_cast<std::size_t>(std::floor(place))];
        const double high = sorted[static_cast<std::size_t>(std::ceil(place))];
        const double quantile = low + (place - std::floor(place)) * (high - low);
        const double slack = 1e-9 * (std::abs(quantile) + 1.0);
        for (const double value : sorted) {
          if (value < quantile - slack) continue;
          if (value > sorted.front()) expected.insert(value);
          break;
        }
      }
      EXPECT_EQ(class_breaks(values, ClassKind::quantile, static_cast<int>(classes)).stops,
                Values(expected.begin(), expected.end()))
          << "round " << round << ", " << classes;
    }
  }
}

TEST(ClassBreaks, LeaveOutAndCountWhatIsNoNumber) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const ClassKind kind : {ClassKind::equal, ClassKind::quantile, ClassKind::jenks}) {
    const ClassBreaks breaks = class_breaks(Values{kNan, 1, kInfinity, 3, -kInfinity}, kind, 2);
    EXPECT_EQ(breaks.left_out, 3U);
    EXPECT_THAT(breaks.counts, ElementsAre(1, 1));
    const ClassBreaks none = class_breaks(Values{kNan}, kind, 2);
    EXPECT_EQ(none.left_out, 1U);
    EXPECT_THAT(none.counts, IsEmpty());
    EXPECT_THAT(class_breaks({}, kind, 2).counts, IsEmpty());
  }
}

TEST(ClassBreaks, AreFewerForFewDifferentValues) {
  for (const ClassKind kind : {ClassKind::equal, ClassKind::quantile, ClassKind::jenks}) {
    EXPECT_THAT(class_breaks(Values{4, 4, 4}, kind, 5).stops, IsEmpty());
    EXPECT_THAT(class_breaks(Values{4, 4, 4}, kind, 5).counts, ElementsAre(3));
    EXPECT_THAT(class_breaks(Values{7, 4, 7, 4}, kind, 5).counts, ElementsAre(2, 2));
    EXPECT_THAT(class_breaks(Values{4, 7}, kind, 0).counts, ElementsAre(2)) << "at least one class";
  }
}

TEST(ClassBreaks, RiseAndCountEachValueOnce) {
  std::mt19937 random(99);
  for (const ClassKind kind : {ClassKind::equal, ClassKind::quantile, ClassKind::jenks}) {
    for (int round = 0; round < 30; ++round) {
      const Values values = random_values(random, 40, round % 3);
      const ClassBreaks breaks = class_breaks(values, kind, 1 + round % kMostClasses);
      EXPECT_EQ(std::ranges::adjacent_find(breaks.stops, std::greater_equal<>()), breaks.stops.end());
      ASSERT_EQ(breaks.counts.size(), breaks.stops.size() + 1);
      EXPECT_EQ(std::accumulate(breaks.counts.begin(), breaks.counts.end(), std::size_t{0}), values.size());
    }
  }
}

}  // namespace
}  // namespace terrella
