#include "base/time_steps.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <string_view>

namespace terrella {
namespace {

/// The number of the last step of an endless series at or before a time, which is not before its first one.
std::int64_t step_at(UtcTime first, const TimePeriod& period, UtcTime time) {
  constexpr double kMonth_ms = 86'400'000.0 * 30.436875;  // a mean month of the Gregorian calendar
  const double period_ms = period.months * kMonth_ms + double(period.length.count());
  auto step = static_cast<std::int64_t>(double((time - first).count()) / period_ms);
  while (step > 0 && after_periods(first, period, step) > time) --step;
  while (after_periods(first, period, step + 1) <= time) ++step;
  return step;
}

UtcTime step_of(const TimeSeries& series, std::int64_t step) {
  return step == 0 ? series.first : after_periods(series.first, series.period, step);
}

/// The last step of a series at or before a time, which is not before its first one.
std::int64_t last_step(const TimeSeries& series, UtcTime time) {
  if (series.count == 1) return 0;
  return time >= series.last ? series.count - 1 : step_at(series.first, series.period, time);
}

TimeSeries one_instant(const NamedTime& time) {
  return {.first = time.from, .last = time.from, .precision = time.precision, .has_z = time.has_z};
}

/// The coarsest precision that tells the steps of a period apart.
TimePrecision precision_of(const TimePeriod& period) {
  using namespace std::chrono;
  if (period.length % minutes(1) != seconds(0)) {
    return period.length % seconds(1) == seconds(0) ? TimePrecision::second : TimePrecision::millisecond;
  }
  if (period.length % days(1) != seconds(0)) return TimePrecision::minute;
  if (period.length != seconds(0)) return TimePrecision::day;
  return period.months % 12 == 0 ? TimePrecision::year : TimePrecision::month;
}

/// Makes the names of the steps of a series differ, where START is coarser than the period: 2026-06-01 and PT6H.
void refine_precision(TimeSeries& series) {
  const TimePrecision fine = precision_of(series.period);
  if (fine <= series.precision) return;
  // A time of day has its zone; a date in front of it was written without one.
  if (fine >= TimePrecision::minute && series.precision < TimePrecision::minute) series.has_z = true;
  series.precision = fine;
}

/// Reads one value and appends its series.
Status append(const std::string& value, UtcTime now, std::vector<TimeSeries>& all) {
  const std::string_view text = value;
  const auto shown = [&] { return "\"" + value.substr(0, 80) + "\""; };
  const std::size_t one = text.find('/'), two = one == text.npos ? text.npos : text.find('/', one + 1);
  const auto first = read_named_time(text.substr(0, one));
  if (!first) return Error{fmt::format("{} is no time in UTC of ISO 8601, such as 2026-06-21", shown())};
  if (one == text.npos) {
    all.push_back(one_instant(*first));
    return Done{};
  }
  const std::string_view end = text.substr(one + 1, two == text.npos ? two : two - one - 1);
  auto last = names_newest(end) ? NamedTime{.from = now} : read_named_time(end);
  if (!last) return Error{fmt::format("the end of {} is no time in UTC of ISO 8601", shown())};
  if (last->from < first->from) return Error{fmt::format("{} ends before it begins", shown())};
  TimeSeries series = one_instant(*first);
  all.push_back(series);
  if (last->from == first->from) return Done{};
  if (two == text.npos) {
    all.push_back(one_instant(*last));
    return Done{};
  }
  const auto period = read_period(text.substr(two + 1));
  if (!period) return Error{fmt::format("the period of {} is none of ISO 8601, such as P1D or PT10M", shown())};
  // A month is at least 28 days long, so this is no fewer than the steps are.
  const double least_ms = double(period->months) * 28.0 * 86'400'000.0 + double(period->length.count());
  if (double((last->from - first->from).count()) / least_ms > double(TimeSteps::kMostInSeries)) {
    return Error{fmt::format("{} has more than {} instants", shown(), TimeSteps::kMostInSeries)};
  }
  series.period = *period;
  series.count = step_at(first->from, *period, last->from) + 1;
  series.last = step_of(series, series.count - 1);
  refine_precision(series);
  all.back() = series;
  return Done{};
}

}  // namespace

Result<TimeSteps> TimeSteps::parse(std::span<const std::string> values, UtcTime now) {
  TimeSteps steps;
  steps.series_.reserve(values.size());
  for (const std::string& value : values) {
    if (Status read = append(value, now, steps.series_); !read) return read.error();
  }
  std::ranges::stable_sort(steps.series_, {}, &TimeSeries::first);
  return steps;
}

std::int64_t TimeSteps::count() const {
  return std::accumulate(series_.begin(), series_.end(), std::int64_t{0},
                         [](std::int64_t sum, const TimeSeries& one) { return sum + one.count; });
}

UtcTime TimeSteps::last() const { return std::ranges::max(series_, {}, &TimeSeries::last).last; }

std::optional<UtcTime> TimeSteps::at_or_before(UtcTime time) const {
  std::optional<UtcTime> best;
  for (const TimeSeries& one : series_) {
    if (one.first > time) break;
    best = std::max(best.value_or(one.first), step_of(one, last_step(one, time)));
  }
  return best;
}

std::optional<UtcTime> TimeSteps::after(UtcTime time) const {
  std::optional<UtcTime> best;
  for (const TimeSeries& one : series_) {
    if (best && one.first >= *best) break;
    if (one.last <= time) continue;
    const UtcTime next = one.first > time ? one.first : step_of(one, last_step(one, time) + 1);
    best = std::min(best.value_or(next), next);
  }
  return best;
}

std::string TimeSteps::text(UtcTime step) const {
  // From the last series that has begun: a single instant is found at once.
  const auto begun = std::ranges::upper_bound(series_, step, {}, &TimeSeries::first);
  const TimeSeries* named = nullptr;
  for (auto one = begun; one != series_.begin();) {
    --one;
    if (step_of(*one, last_step(*one, step)) == step) return time_text(step, one->precision, one->has_z);
    if (named == nullptr || (step > named->last && step <= one->last)) named = &*one;
  }
  if (named == nullptr) return time_text(step, TimePrecision::second, true);
  return time_text(step, named->precision, named->has_z);
}

std::string TimeSteps::summary() const {
  if (empty()) return "no instants";
  const std::string range = text(first()) == text(last()) ? text(first()) : text(first()) + " to " + text(last());
  std::string all = fmt::format("{}: {} instant{}", range, count(), count() == 1 ? "" : "s");
  const auto regular = std::ranges::find_if(series_, [](const TimeSeries& one) { return one.count > 1; });
  if (regular == series_.end()) return all;
  const auto fits = [&](const TimeSeries& one) { return one.count == 1 || one.period == regular->period; };
  if (!std::ranges::all_of(series_, fits)) return all + ", several periods";
  all += ", " + period_text(regular->period);
  std::size_t gaps = 0;
  UtcTime until = series_.front().last;
  for (const TimeSeries& one : series_) {
    if (one.first > after_periods(until, regular->period, 1)) ++gaps;
    until = std::max(until, one.last);
  }
  return gaps == 0 ? all : all + fmt::format(", {} gap{}", gaps, gaps == 1 ? "" : "s");
}

}  // namespace terrella
