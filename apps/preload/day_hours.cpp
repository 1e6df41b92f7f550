#include "apps/preload/day_hours.h"

#include <ctime>
#include <optional>
#include <string_view>

#include "base/number.h"

namespace terrella {
namespace {

using std::chrono::minutes;
using std::chrono::seconds;
constexpr seconds kWholeDay{86400};

std::optional<minutes> parse_moment(std::string_view text) {
  if (text.size() != 5 || text[2] != ':') return std::nullopt;
  const auto digit = [&text](std::size_t at) { return text[at] >= '0' && text[at] <= '9' ? text[at] - '0' : 100; };
  const int hour = 10 * digit(0) + digit(1), minute = 10 * digit(3) + digit(4);
  if (hour > 23 || minute > 59) return std::nullopt;
  return minutes(60 * hour + minute);
}

}  // namespace

Result<DayHours> parse_day_hours(const std::string& text) {
  constexpr std::size_t kDash = 5, kLength = 11;
  const bool utc = text.ends_with('Z');
  const std::string_view span = std::string_view(text).substr(0, text.size() - (utc ? 1 : 0));
  const bool long_enough = span.size() == kLength && span[kDash] == '-';
  const auto first = long_enough ? parse_moment(span.substr(0, kDash)) : std::nullopt;
  const auto last = long_enough ? parse_moment(span.substr(kDash + 1)) : std::nullopt;
  if (!first || !last || *first == *last) {
    return Error{in_quotes(text) +
                 " is no part of a day; write FROM-TO, as 22:00-06:00 in local time or 22:00-06:00Z in "
                 "UTC"};
  }
  return DayHours{.first = *first, .last = *last, .utc = utc, .text = text};
}

seconds wait_for(const DayHours& hours, seconds since_midnight) {
  const bool from_begin = since_midnight >= hours.first, to_end = since_midnight < hours.last;
  const bool open = hours.first < hours.last ? from_begin && to_end : from_begin || to_end;
  return open ? seconds(0) : (hours.first - since_midnight + kWholeDay) % kWholeDay;
}

seconds since_midnight(const DayHours& hours, std::chrono::system_clock::time_point now) {
  const std::time_t time = std::chrono::system_clock::to_time_t(now);
  std::tm parts{};
  hours.utc ? gmtime_r(&time, &parts) : localtime_r(&time, &parts);
  return std::chrono::hours(parts.tm_hour) + minutes(parts.tm_min) + seconds(parts.tm_sec);
}

}  // namespace terrella
