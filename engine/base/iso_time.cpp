#include "base/iso_time.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <utility>

namespace terrella {
namespace {

using std::chrono::sys_days;
using std::chrono::year_month;
using std::chrono::year_month_day;

bool take(std::string_view& text, char c) {
  if (!text.starts_with(c)) return false;
  text.remove_prefix(1);
  return true;
}

/// Takes a number of so many digits; nothing if they are not there.
std::optional<int> take_digits(std::string_view& text, std::size_t count) {
  int value = 0;
  const char* const end = text.data() + std::min(count, text.size());
  const bool starts_well = text.size() >= count && text[0] >= '0' && text[0] <= '9';
  if (!starts_well || std::from_chars(text.data(), end, value).ptr != end) return std::nullopt;
  text.remove_prefix(count);
  return value;
}

/// Takes the digits after a point, as milliseconds; those beyond are cut off.
std::chrono::milliseconds take_fraction(std::string_view& text) {
  int digits = 0, value = 0;
  while (!text.empty() && text[0] >= '0' && text[0] <= '9') {
    if (digits++ < 3) value = 10 * value + (text[0] - '0');
    text.remove_prefix(1);
  }
  while (digits++ < 3) value *= 10;
  return std::chrono::milliseconds(value);
}

/// Reads hh:mm[:ss[.fraction]] of a day. Hour 24 is the next day's first one.
std::optional<NamedTime> read_clock(std::string_view text, sys_days day) {
  using namespace std::chrono;
  NamedTime time{.precision = TimePrecision::minute, .has_z = text.ends_with('Z')};
  if (time.has_z) text.remove_suffix(1);
  const auto hour = take_digits(text, 2);
  const auto minute = take(text, ':') ? take_digits(text, 2) : std::nullopt;
  if (!hour || !minute || *hour > 24 || *minute > 59) return std::nullopt;
  time.from = day + hours(*hour) + minutes(*minute);
  time.before = time.from + minutes(1);
  if (take(text, ':')) {
    const auto second = take_digits(text, 2);
    if (!second || *second > 59) return std::nullopt;
    time.precision = TimePrecision::second;
    time.from += seconds(*second);
    time.before = time.from + seconds(1);
    if (take(text, '.')) {
      time.precision = TimePrecision::millisecond;
      time.from += take_fraction(text);
      time.before = time.from + milliseconds(1);
    }
  }
  return text.empty() ? std::optional(time) : std::nullopt;
}

/// The length of one of a period's units that are not months.
std::optional<std::chrono::milliseconds> length_of(char unit, bool is_clock) {
  using namespace std::chrono;
  if (!is_clock && unit == 'W') return weeks(1);
  if (!is_clock && unit == 'D') return days(1);
  if (is_clock && unit == 'H') return hours(1);
  if (is_clock && unit == 'M') return minutes(1);
  if (is_clock && unit == 'S') return seconds(1);
  return std::nullopt;
}

}  // namespace

bool names_newest(std::string_view text) {
  constexpr std::array<std::string_view, 4> kWords = {"current", "latest", "now", "present"};
  const auto is = [text](std::string_view word) {
    return std::ranges::equal(text, word, [](char a, char b) { return (a | 0x20) == b; });
  };
  return std::ranges::any_of(kWords, is);
}

std::optional<NamedTime> read_named_time(std::string_view text) {
  namespace chrono = std::chrono;
  const auto span = [](year_month_day from, year_month_day before, TimePrecision precision) {
    return NamedTime{.from = sys_days(from), .before = sys_days(before), .precision = precision};
  };
  const auto y = take_digits(text, 4);
  if (!y) return std::nullopt;
  const chrono::year year(*y);
  if (text.empty()) return span(year / 1 / 1, (year + chrono::years(1)) / 1 / 1, TimePrecision::year);
  const auto m = take(text, '-') ? take_digits(text, 2) : std::nullopt;
  if (!m || *m < 1 || *m > 12) return std::nullopt;
  const year_month month = year / *m;
  if (text.empty()) return span(month / 1, (month + chrono::months(1)) / 1, TimePrecision::month);
  const auto d = take(text, '-') ? take_digits(text, 2) : std::nullopt;
  if (!d || !(month / *d).ok()) return std::nullopt;
  const sys_days day = month / *d;
  if (take(text, 'T')) return read_clock(text, day);
  NamedTime whole = span(day, day + chrono::days(1), TimePrecision::day);
  whole.has_z = take(text, 'Z');
  return text.empty() ? std::optional(whole) : std::nullopt;
}

std::string time_text(UtcTime time, TimePrecision precision, bool with_z) {
  const auto day = std::chrono::floor<std::chrono::days>(time);
  const year_month_day date(day);
  const std::chrono::hh_mm_ss clock(time - day);
  std::string text = fmt::format("{:04}", int(date.year()));
  if (precision >= TimePrecision::month) text += fmt::format("-{:02}", unsigned(date.month()));
  if (precision >= TimePrecision::day) text += fmt::format("-{:02}", unsigned(date.day()));
  if (precision >= TimePrecision::minute) {
    text += fmt::format("T{:02}:{:02}", clock.hours().count(), clock.minutes().count());
  }
  if (precision >= TimePrecision::second) text += fmt::format(":{:02}", clock.seconds().count());
  if (precision >= TimePrecision::millisecond) text += fmt::format(".{:03}", clock.subseconds().count());
  return with_z ? text + "Z" : text;
}

std::optional<TimePeriod> read_period(std::string_view text) {
  constexpr int kMost = 1'000'000;
  TimePeriod period;
  bool is_clock = false;
  if (!take(text, 'P')) return std::nullopt;
  while (!text.empty()) {
    if (!is_clock && take(text, 'T')) is_clock = true;
    int count = 0;
    const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), count);
    const auto digits = static_cast<std::size_t>(end - text.data());
    if (fault != std::errc() || count < 0 || count > kMost || digits >= text.size()) return std::nullopt;
    const char unit = text[digits];
    text.remove_prefix(digits + 1);
    if (!is_clock && (unit == 'Y' || unit == 'M')) {
      period.months += unit == 'Y' ? 12 * count : count;
    } else if (const auto length = length_of(unit, is_clock)) {
      period.length += count * *length;
    } else {
      return std::nullopt;
    }
  }
  return period == TimePeriod{} ? std::nullopt : std::optional(period);
}

std::string period_text(const TimePeriod& period) {
  using namespace std::chrono;
  std::string text = "P";
  const auto add = [&text](auto count, char unit) {
    if (count > 0) text += fmt::format("{}{}", count, unit);
  };
  add(period.months / 12, 'Y');
  add(period.months % 12, 'M');
  const auto whole_days = duration_cast<days>(period.length);
  add(whole_days.count(), 'D');
  const hh_mm_ss clock(period.length - whole_days);
  if (clock.to_duration() > milliseconds(0)) text += 'T';
  add(clock.hours().count(), 'H');
  add(clock.minutes().count(), 'M');
  add(clock.seconds().count(), 'S');
  return text;
}

UtcTime after_periods(UtcTime from, const TimePeriod& period, std::int64_t count) {
  const auto day = std::chrono::floor<std::chrono::days>(from);
  const auto clock = from - day;
  const year_month_day date(day);
  const auto months = std::chrono::months(static_cast<int>(count * period.months));
  const year_month_day moved = date + months;
  const sys_days target = moved.ok() ? sys_days(moved) : sys_days(moved.year() / moved.month() / std::chrono::last);
  return target + clock + count * period.length;
}

}  // namespace terrella
