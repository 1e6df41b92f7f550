// Times of services: names of ISO 8601, periods, and the instants of series.
#include "base/time_steps.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

namespace terrella {
namespace {

using testing::HasSubstr;

UtcTime at(const char* text) { return read_named_time(text).value().from; }

TimeSteps steps(std::vector<std::string> values) {
  Result<TimeSteps> read = TimeSteps::parse(values, at("2026-06-21T12:00:00Z"));
  EXPECT_TRUE(read) << read.error().message;
  return read ? *std::move(read) : TimeSteps{};
}

std::string fault(const char* value) {
  const Result<TimeSteps> read = TimeSteps::parse(std::vector<std::string>{value}, at("2026-06-21"));
  return read ? "" : read.error().message;
}

// 1,234,567,890 s after 1970 it was 2009-02-13T23:31:30Z; 2000 was a leap year and 1900 was none.
TEST(NamedTime, IsAllOfWhatTheTextNames) {
  using std::chrono::seconds;
  EXPECT_EQ(at("2009-02-13T23:31:30Z"), UtcTime(seconds(1'234'567'890)));
  EXPECT_EQ(at("1969-12-31T23:59:59"), UtcTime(seconds(-1)));
  EXPECT_EQ(read_named_time("2000-02")->before, at("2000-03-01"));
  EXPECT_EQ(read_named_time("2000-02")->before - at("2000-02"), std::chrono::days(29));
  EXPECT_EQ(read_named_time("1900-02")->before - at("1900-02"), std::chrono::days(28));
  EXPECT_EQ(read_named_time("2011")->before, at("2012"));
  EXPECT_EQ(read_named_time("2011-12-31")->before, at("2012-01-01"));
  EXPECT_EQ(read_named_time("2011-12-31T24:00Z")->from, at("2012-01-01"));
  EXPECT_EQ(at("2011-12-31T10:20:30.25Z") - at("2011-12-31T10:20:30Z"), std::chrono::milliseconds(250));
  for (const char* wrong : {"", "20", "2011-1-1", "2011-13", "2011-02-29", "2011-02-28T", "2011-02-28T25:00",
                            "+011-01-01", "2011-02-28T10:61", "2011-02-28T10:00:00+01:00", "2011-02-28 10:00", "now"}) {
    EXPECT_FALSE(read_named_time(wrong)) << wrong;
  }
}

TEST(NamedTime, IsWrittenAsItWasRead) {
  for (const char* text : {"0987", "2004-08", "2004-08-09", "2004-08-09T10:11Z", "2004-08-09T10:11:12Z",
                           "2004-08-09T10:11:12", "1812-08-09T10:11:12.345Z"}) {
    const NamedTime time = *read_named_time(text);
    EXPECT_EQ(time_text(time.from, time.precision, time.has_z), text);
  }
}

TEST(Periods, AreReadAndWritten) {
  for (const char* text : {"P1D", "P8D", "P1M", "P1Y", "P1Y6M", "PT10M", "PT1H30M", "P1DT12H", "PT30S"}) {
    ASSERT_TRUE(read_period(text)) << text;
    EXPECT_EQ(period_text(*read_period(text)), text);
  }
  EXPECT_EQ(period_text(*read_period("P2W")), "P14D");
  EXPECT_EQ(period_text(*read_period("PT24H")), "P1D");
  for (const char* wrong :
       {"", "P", "PT", "P0D", "PT0S", "1D", "P1", "PD", "P-1D", "P1H", "PT1D", "P1.5D", "P9999999999D", "P1D "}) {
    EXPECT_FALSE(read_period(wrong)) << wrong;
  }
}

TEST(TimeStepsOf, ADailySeriesAreItsDays) {
  const TimeSteps daily = steps({"2024-02-27/2024-03-02/P1D"});
  EXPECT_EQ(daily.count(), 5);
  EXPECT_EQ(daily.text(daily.first()), "2024-02-27");
  EXPECT_EQ(daily.text(daily.last()), "2024-03-02");
  EXPECT_EQ(daily.at_or_before(at("2024-02-29T13:00Z")), at("2024-02-29"));
  EXPECT_EQ(daily.at_or_before(at("2024-02-29")), at("2024-02-29"));
  EXPECT_FALSE(daily.at_or_before(at("2024-02-26T23:59Z")));
  EXPECT_EQ(daily.at_or_before(at("2030")), at("2024-03-02"));
  EXPECT_EQ(daily.after(at("2024-02-29")), at("2024-03-01"));
  EXPECT_EQ(daily.after(at("2020")), at("2024-02-27"));
  EXPECT_FALSE(daily.after(at("2024-03-02")));
}

TEST(TimeStepsOf, APeriodThatDoesNotReachTheEndStopsBeforeIt) {
  const TimeSteps eight = steps({"2024-01-01/2024-01-20/P8D"});
  EXPECT_EQ(eight.count(), 3);
  EXPECT_EQ(eight.text(eight.last()), "2024-01-17");
}

// By hand: calendar months, with the last day of short ones.
TEST(TimeStepsOf, MonthsAndYearsAreThoseOfTheCalendar) {
  const TimeSteps monthly = steps({"2023-10-31/2024-03-31/P1M"});
  std::vector<std::string> all;
  for (auto step = monthly.at_or_before(monthly.first()); step; step = monthly.after(*step))
    all.push_back(monthly.text(*step));
  EXPECT_EQ(all, (std::vector<std::string>{"2023-10-31", "2023-11-30", "2023-12-31", "2024-01-31", "2024-02-29",
                                           "2024-03-31"}));
  EXPECT_EQ(steps({"1980-01-01/2020-12-31/P1Y"}).count(), 41);
  EXPECT_EQ(steps({"1980-01-01/2020-12-31/P1M"}).count(), 12 * 41);
}

TEST(TimeStepsOf, SeriesAndSingleInstantsInAnyOrder) {
  const TimeSteps some = steps({"2024-03-01", "2024-01-01/2024-01-03/P1D", "2024-02-01/2024-02-02/P1D"});
  EXPECT_EQ(some.count(), 6);
  EXPECT_EQ(some.after(at("2024-01-03")), at("2024-02-01"));
  EXPECT_EQ(some.at_or_before(at("2024-01-20")), at("2024-01-03"));
  EXPECT_EQ(some.at_or_before(at("2024-02-20")), at("2024-02-02"));
  EXPECT_EQ(some.summary(), "2024-01-01 to 2024-03-01: 6 instants, P1D, 2 gaps");
  EXPECT_EQ(steps({"2024-03-01"}).summary(), "2024-03-01: 1 instant");
  EXPECT_EQ(steps({"2024-01-01/2024-01-03/P1D", "2025-01-01/2025-12-01/P1M"}).summary(),
            "2024-01-01 to 2025-12-01: 15 instants, several periods");
  EXPECT_EQ(steps({"2024-01-01T00:00:00Z/2024-01-02T00:00:00Z/PT10M"}).summary(),
            "2024-01-01T00:00:00Z to 2024-01-02T00:00:00Z: 145 instants, PT10M");
}

std::vector<std::string> names(const TimeSteps& some) {
  std::vector<std::string> all;
  for (auto step = some.at_or_before(some.first()); step; step = some.after(*step)) all.push_back(some.text(*step));
  return all;
}

TEST(TimeStepsOf, EachInstantHasANameOfItsOwn) {
  using Names = std::vector<std::string>;
  EXPECT_EQ(names(steps({"2026-06-01/2026-06-02/PT12H"})),
            (Names{"2026-06-01T00:00Z", "2026-06-01T12:00Z", "2026-06-02T00:00Z"}));
  EXPECT_EQ(names(steps({"2026-06-01/2026-06-01T00:00:01Z/PT1S"})),
            (Names{"2026-06-01T00:00:00Z", "2026-06-01T00:00:01Z"}));
  EXPECT_EQ(names(steps({"2026/2026-03/P1M"})), (Names{"2026-01", "2026-02", "2026-03"}));
  EXPECT_EQ(names(steps({"2026-05/2026-06/P15D"})), (Names{"2026-05-01", "2026-05-16", "2026-05-31"}));
  EXPECT_EQ(names(steps({"2024/2026/P1Y"})), (Names{"2024", "2025", "2026"})) << "no finer than needed";
  const TimeSteps mixed = steps({"2000-01-01/2026-01-01/P1D", "2010-05-05T12:00Z"});
  EXPECT_EQ(mixed.text(at("2010-05-05T12:00Z")), "2010-05-05T12:00Z");
  EXPECT_EQ(mixed.text(at("2010-05-05")), "2010-05-05");
  EXPECT_EQ(mixed.text(at("2010-05-06")), "2010-05-06") << "after the single one";
}

TEST(TimeStepsOf, ASeriesThatGoesOnEndsNow) {
  EXPECT_EQ(steps({"2026-06-01/current/P1D"}).count(), 21);
  EXPECT_EQ(steps({"2026-06-01/PRESENT/P1D"}).last(), at("2026-06-21"));
}

// As of GIBS' sub-daily layers: single instants, one by one.
TEST(TimeStepsOf, FortyThousandInstantsAreFoundAgain) {
  std::vector<std::string> values;
  const UtcTime first = at("2024-01-01");
  for (int k = 0; k < 40'000; ++k)
    values.push_back(time_text(first + std::chrono::minutes(11 * k), TimePrecision::second, true));
  const TimeSteps all = steps(values);
  EXPECT_EQ(all.count(), 40'000);
  for (const int k : {0, 1, 777, 39'998}) {
    const UtcTime step = first + std::chrono::minutes(11 * k);
    EXPECT_EQ(all.at_or_before(step + std::chrono::minutes(10)), step);
    EXPECT_EQ(all.after(step), step + std::chrono::minutes(11));
    EXPECT_EQ(all.text(step), values[std::size_t(k)]);
  }
}

TEST(TimeStepsOf, HostileSeriesAreRefusedByName) {
  EXPECT_THAT(fault("1000-01-01/9000-01-01/PT0.1S"), HasSubstr("the period of"));
  EXPECT_THAT(fault("1000-01-01/9000-01-01/PT1S"), HasSubstr("more than 1000000000 instants"));
  EXPECT_THAT(fault("2024-01-02/2024-01-01/P1D"), HasSubstr("ends before it begins"));
  EXPECT_THAT(fault("2024-01-01/2024-02-01/P0D"), HasSubstr("the period of"));
  EXPECT_THAT(fault("2024-01-01/2024-02-30/P1D"), HasSubstr("the end of"));
  EXPECT_THAT(fault("soon"), HasSubstr("\"soon\" is no time"));
  EXPECT_EQ(fault("1000-01-01/9000-01-01/P1D"), "");
}

}  // namespace
}  // namespace terrella
