#include "streaming/remote/wmts/wmts_time.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string_view>

#include "streaming/remote/wmts/xml_names.h"

namespace terrella {
namespace {

constexpr std::int64_t kDay_s = 86'400;

/// Period described by a date or time: 2004-08 is all of August.
struct Span {
  std::int64_t from_s, to_s;  ///< since 1970, last second included
};

std::optional<int> digits(std::string_view& text, std::size_t count) {
  const std::string_view number = text.substr(0, count);
  if (number.size() != count || number.find_first_not_of("0123456789") != std::string_view::npos) return std::nullopt;
  text.remove_prefix(count);
  return static_cast<int>(*to_integer(number));
}

bool take(std::string_view& text, char c) {
  if (!text.starts_with(c)) return false;
  text.remove_prefix(1);
  return true;
}

/// hh:mm[:ss[.fraction]][Z] of a day.
std::optional<Span> clock_span(std::string_view text, std::int64_t day_s) {
  const auto hour = digits(text, 2);
  const auto minute = take(text, ':') ? digits(text, 2) : std::nullopt;
  if (!hour || !minute || *hour > 24 || *minute > 59) return std::nullopt;
  const std::int64_t from = day_s + std::int64_t{3600} * *hour + std::int64_t{60} * *minute;
  std::optional<int> second;
  if (take(text, ':') && !(second = digits(text, 2))) return std::nullopt;
  if (second && take(text, '.')) text.remove_prefix(std::min(text.find_first_not_of("0123456789"), text.size()));
  take(text, 'Z');
  if (!text.empty()) return std::nullopt;
  return second ? Span{from + *second, from + *second} : Span{from, from + 59};
}

/// YYYY[-MM[-DD[Thh:mm…]]]
std::optional<Span> span_of(std::string_view text) {
  namespace chrono = std::chrono;
  const auto start = [](chrono::year_month_day date) {
    return std::int64_t{chrono::sys_days(date).time_since_epoch().count()} * kDay_s;
  };
  const auto y = digits(text, 4);
  if (!y) return std::nullopt;
  const chrono::year year(*y);
  if (text.empty()) return Span{start(year / 1 / 1), start((year + chrono::years(1)) / 1 / 1) - 1};
  const auto m = take(text, '-') ? digits(text, 2) : std::nullopt;
  if (!m || *m < 1 || *m > 12) return std::nullopt;
  const chrono::year_month month = year / *m;
  if (text.empty()) return Span{start(month / 1), start((month + chrono::months(1)) / 1) - 1};
  const auto d = take(text, '-') ? digits(text, 2) : std::nullopt;
  if (!d || !(month / *d).ok()) return std::nullopt;
  const std::int64_t day_s = start(month / *d);
  if (text.empty()) return Span{day_s, day_s + kDay_s - 1};
  return take(text, 'T') ? clock_span(text, day_s) : std::nullopt;
}

/// A listed value: START/END/PERIOD, or one time.
std::optional<Span> listed_span(std::string_view value) {
  const std::size_t slash = value.find('/');
  const auto first = span_of(value.substr(0, slash));
  if (!first || slash == std::string_view::npos) return first;
  const std::string_view rest = value.substr(slash + 1);
  const auto last = span_of(rest.substr(0, rest.find('/')));
  return last ? std::optional(Span{first->from_s, last->to_s}) : std::nullopt;
}

bool is_listed(const WmtsDimension& dimension, const std::string& time) {
  const auto wanted = span_of(time);
  return std::ranges::any_of(dimension.values, [&](const std::string& value) {
    const auto listed = listed_span(value);
    return value == time || (wanted && listed && wanted->from_s >= listed->from_s && wanted->from_s <= listed->to_s);
  });
}

bool is_newest(const WmtsDimension& dimension, const std::string& time) {
  const auto chosen = span_of(time);
  if (!chosen) return true;  // "current", "default" and the like
  std::optional<std::int64_t> last_s;
  for (const std::string& value : dimension.values) {
    const auto listed = listed_span(value);
    if (listed) last_s = std::max(last_s.value_or(listed->to_s), listed->to_s);
  }
  return last_s && chosen->to_s + kDay_s > *last_s;
}

std::string list_of(const WmtsDimension& dimension) {
  if (dimension.values.empty()) return "no value is listed";
  constexpr std::size_t kShown = 4;
  std::string list = "listed:";
  const std::size_t all = dimension.values.size();
  for (std::size_t i = 0; i < all; ++i) {
    if (i == kShown && all > kShown + 1) list += fmt::format(" … ({} more)", all - kShown - 1);
    if (i < kShown || i + 1 == all) list += " " + dimension.values[i].substr(0, 80);
  }
  return list;
}

}  // namespace

Result<ChosenTime> choose_time(const WmtsDimension& dimension, const std::string& given) {
  const std::string& value = given.empty() ? dimension.otherwise : given;
  if (value.empty())
    return Error{fmt::format("its {} has no default; say ‹time› ({})", dimension.name, list_of(dimension))};
  const bool check = !given.empty() && given != dimension.otherwise && !dimension.values.empty();
  if (check && !is_listed(dimension, value)) {
    return Error{fmt::format("it has nothing at ‹time› {} ({})", value, list_of(dimension))};
  }
  return ChosenTime{value, is_newest(dimension, value)};
}

}  // namespace terrella
