#include "streaming/remote/tile_set_time.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "base/number.h"
#include "streaming/remote/web_address.h"

namespace terrella {
namespace {

constexpr std::string_view kTime = "time", kTimeFormat = "time:";
constexpr const char* kTimeCodes = "%Y %y %m %b %B %d %j %H %M %S %s %%";
constexpr std::array<std::string_view, 12> kMonths = {"January",   "February", "March",    "April",
                                                      "May",       "June",     "July",     "August",
                                                      "September", "October",  "November", "December"};

/// The fields of a time in UTC that the codes of a format write.
struct TimeFields {
  explicit TimeFields(UtcTime time)
      : date(std::chrono::floor<std::chrono::days>(time)),
        clock(std::chrono::floor<std::chrono::seconds>(time) - std::chrono::floor<std::chrono::days>(time)),
        day_of_year((std::chrono::floor<std::chrono::days>(time) -
                     std::chrono::sys_days(date.year() / std::chrono::January / 1))
                        .count() +
                    1),
        unix_s(std::chrono::floor<std::chrono::seconds>(time.time_since_epoch()).count()) {}
  std::chrono::year_month_day date;
  std::chrono::hh_mm_ss<std::chrono::seconds> clock;
  std::int64_t day_of_year;
  std::int64_t unix_s;
};

/// The text of one code; nothing for an unknown one.
std::optional<std::string> text_of_code(char code, const TimeFields& time) {
  const std::string_view month = kMonths.at(static_cast<unsigned>(time.date.month()) - 1);
  switch (code) {
    case 'Y':
      return fmt::format("{:04}", static_cast<int>(time.date.year()));
    case 'y':
      return fmt::format("{:02}", static_cast<int>(time.date.year()) % 100);
    case 'm':
      return fmt::format("{:02}", static_cast<unsigned>(time.date.month()));
    case 'b':
      return std::string(month.substr(0, 3));
    case 'B':
      return std::string(month);
    case 'd':
      return fmt::format("{:02}", static_cast<unsigned>(time.date.day()));
    case 'j':
      return fmt::format("{:03}", time.day_of_year);
    case 'H':
      return fmt::format("{:02}", time.clock.hours().count());
    case 'M':
      return fmt::format("{:02}", time.clock.minutes().count());
    case 'S':
      return fmt::format("{:02}", time.clock.seconds().count());
    case 's':
      return std::to_string(time.unix_s);
    case '%':
      return "%";
    default:
      return std::nullopt;
  }
}

/// The instant that a time names, the last step for "current" and the like; none for "default", which a server may mean
/// as it likes.
std::optional<UtcTime> instant_named(const TimeSteps& steps, const std::string& time) {
  if (names_newest(time)) return steps.last();
  const auto named = read_named_time(time);
  return named ? std::optional(named->from) : std::nullopt;
}

}  // namespace

Result<std::string> format_time(UtcTime time, std::string_view format) {
  const TimeFields fields(time);
  std::string text;
  for (std::size_t i = 0; i < format.size(); ++i) {
    if (format[i] != '%') {
      text += format[i];
      continue;
    }
    const auto written = i + 1 < format.size() ? text_of_code(format[i + 1], fields) : std::nullopt;
    if (!written) return Error{std::string(format.substr(i, 2))};
    text += *written;
    ++i;
  }
  return text;
}

UtcTime end_of(const TimeSeries& series) {
  const auto last = read_named_time(time_text(series.last, series.precision, series.has_z));
  return last ? last->before : series.last;
}

bool is_newest(const TimeSteps& steps, const std::string& time) {
  const auto chosen = read_named_time(time);
  const auto reaches = [&chosen](const TimeSeries& one) { return chosen->before + std::chrono::days(1) > end_of(one); };
  return !chosen || (!steps.empty() && std::ranges::all_of(steps.series(), reaches));
}

void set_steps(TimeSteps steps, TileSetInfo& info) {
  if (steps.empty()) return;
  info.times = steps.summary();
  info.instant = instant_named(steps, info.time);
  info.steps = std::make_shared<const TimeSteps>(std::move(steps));
}

Result<RemoteTileSet> at_time(const RemoteTileSet& set, UtcTime time) {
  const auto& steps = set.info.steps;
  if (!steps) return Error{fmt::format("{}: has no list of times", set.info.name)};
  const auto step = steps->at_or_before(time);
  if (!step) {
    return Error{fmt::format("{}: it has nothing at {}; its first time is {}", set.info.name,
                             time_text(time, TimePrecision::second, true), steps->text(steps->first()))};
  }
  RemoteTileSet other = set;
  other.info.time = steps->text(*step);
  other.info.instant = step;
  // Another life is the user's.
  if (!set.missing_life || *set.missing_life == kNewestMissingLife) {
    const bool newest = is_newest(*steps, other.info.time);
    other.missing_life = newest ? std::optional(kNewestMissingLife) : std::nullopt;
  }
  return other;
}

bool has_time(std::string_view text) {
  return text.find("{time}") != std::string_view::npos || text.find("{time:") != std::string_view::npos;
}

bool is_time_placeholder(std::string_view name) { return name == kTime || name.starts_with(kTimeFormat); }

std::string fault_of_time_placeholder(std::string_view name) {
  if (!name.starts_with(kTimeFormat)) return {};
  const auto text = format_time(UtcTime(), name.substr(kTimeFormat.size()));
  if (!text) {
    return fmt::format("has the unknown code {} in {{{}}}; known are {}", text.error().message, name, kTimeCodes);
  }
  return text->empty() ? fmt::format("has no format in {{{}}}; write {{time:%Y-%m-%d}}", name) : std::string();
}

std::string time_in_url(const TileSetInfo& info, std::string_view name) {
  if (name == kTime) return percent_encode(info.time);
  if (!info.instant) return {};
  const auto text = format_time(*info.instant, name.substr(kTimeFormat.size()));
  return text ? *text : std::string();
}

Url url_at_its_time(const RemoteTileSet& set) {
  std::string url;
  std::string_view rest = set.url.with_secrets();
  for (std::size_t at = rest.find("{time"); at != std::string_view::npos; at = rest.find("{time")) {
    const std::size_t end = std::min(rest.find('}', at), rest.size() - 1);
    url += rest.substr(0, at);
    url += time_in_url(set.info, rest.substr(at + 1, end - at - 1));
    rest.remove_prefix(end + 1);
  }
  return url.append(rest);
}

Status choose_template_time(RemoteTileSet& set, const RemoteOptions& options, const std::string& where) {
  const bool timed = has_time(set.url.with_secrets());
  if (!timed && options.times.empty() && options.time.empty()) return Done{};
  if (!timed) return Error{where + ": the URL template has no {time}, so ‹time› and ‹times› have no use"};
  if (options.times.empty()) {
    return Error{where + ": the URL template has {time}; say its instants with ‹times›, as 2026-06-01/2026-06-30/P1D"};
  }
  using std::chrono::floor;
  const UtcTime now = floor<std::chrono::milliseconds>(std::chrono::system_clock::now());
  Result<TimeSteps> steps = TimeSteps::parse(options.times, now);
  if (!steps) return Error{fmt::format("{}: ‹times›: {}", where, steps.error().message)};
  if (!options.time.empty() && !read_named_time(options.time) && !names_newest(options.time) &&
      options.time != "default") {
    return Error{fmt::format("{}: ‹time› {} is no time in UTC of ISO 8601, such as 2026-06-21", where,
                             in_quotes(options.time.substr(0, 80)))};
  }
  const UtcTime wanted = instant_named(*steps, options.time).value_or(steps->last());
  set_steps(*std::move(steps), set.info);
  Result<RemoteTileSet> chosen = at_time(set, wanted);
  if (!chosen) return Error{where + ": " + chosen.error().message};
  set = *std::move(chosen);
  return Done{};
}

}  // namespace terrella
