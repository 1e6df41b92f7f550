#include "apps/preload/preload_times.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <optional>
#include <set>
#include <span>
#include <string_view>
#include <system_error>
#include <utility>

#include "apps/open_scene/open_cache.h"
#include "base/number.h"
#include "streaming/remote/tile_set_time.h"

namespace terrella {
namespace {

/// The time that a text names, now for "current" and the like.
std::optional<NamedTime> read_end(std::string_view text, UtcTime now) {
  if (names_newest(text)) return NamedTime{.from = now, .before = now + std::chrono::milliseconds(1)};
  return read_named_time(text);
}

/// The ends of a value A/B without a period.
std::optional<std::pair<NamedTime, NamedTime>> read_span(const std::string& value, UtcTime now) {
  const std::size_t slash = value.find('/');
  if (slash == std::string::npos || value.find('/', slash + 1) != std::string::npos) return std::nullopt;
  const auto first = read_named_time(std::string_view(value).substr(0, slash));
  const auto last = read_end(std::string_view(value).substr(slash + 1), now);
  if (!first || !last) return std::nullopt;
  return std::pair(*first, *last);
}

std::optional<UtcTime> at_or_after(const TimeSteps& steps, UtcTime time) {
  return steps.after(time - UtcTime::duration(1));
}

/// Collects steps, up to the limit.
class StepList {
 public:
  explicit StepList(const TimeSteps& steps) : steps_(steps) {}

  Status add_span(const NamedTime& first, const NamedTime& last) {
    for (auto step = at_or_after(steps_, first.from); step && *step < last.before; step = steps_.after(*step)) {
      if (Status added = add(*step); !added) return added;
    }
    return Done{};
  }
  Status add_members(const TimeSteps& instants) {
    for (std::optional<UtcTime> step = steps_.first(); step; step = steps_.after(*step)) {
      if (instants.at_or_before(*step) != step) continue;
      if (Status added = add(*step); !added) return added;
    }
    return Done{};
  }
  Status add_instants(const TimeSteps& instants) {
    for (std::optional<UtcTime> time = instants.first(); time;) {
      const auto step = steps_.at_or_before(*time);
      if (!step) {
        return Error{fmt::format("--times: the source has nothing at {}; its first time is {}",
                                 time_text(*time, TimePrecision::second, true), steps_.text(steps_.first()))};
      }
      if (Status added = add(*step); !added) return added;
      // Instants before the next step have the same one.
      const auto next = steps_.after(*time);
      if (!next) break;
      time = at_or_after(instants, *next);
    }
    return Done{};
  }
  [[nodiscard]] std::vector<UtcTime> all() const { return {found_.begin(), found_.end()}; }

 private:
  Status add(UtcTime step) {
    found_.insert(step);
    if (found_.size() <= kMostPreloadTimes) return Done{};
    return Error{fmt::format("--times: more than {} instants; take fewer at a time", kMostPreloadTimes)};
  }

  const TimeSteps& steps_;
  std::set<UtcTime> found_;
};

enum class StepRule { last_before, named };

Status add_value(const std::string& value, StepList& list, StepRule rule) {
  const UtcTime now = std::chrono::floor<std::chrono::milliseconds>(std::chrono::system_clock::now());
  if (const auto named = read_named_time(value); named && rule == StepRule::named) {
    return list.add_span(*named, *named);
  }
  if (const auto span = read_span(value, now)) {
    if (span->second.from < span->first.from) {
      return Error{fmt::format("--times: {} ends before it begins", in_quotes(value))};
    }
    return list.add_span(span->first, span->second);
  }
  const auto read = TimeSteps::parse(std::span(&value, 1), now);
  if (!read) return Error{"--times: " + read.error().message};
  return rule == StepRule::named ? list.add_members(*read) : list.add_instants(*read);
}

}  // namespace

Result<std::vector<UtcTime>> preload_instants(const std::vector<std::string>& values, const TimeSteps& steps) {
  StepList list(steps);
  for (const std::string& value : values) {
    if (Status added = add_value(value, list, StepRule::last_before); !added) return added.error();
  }
  if (list.all().empty()) {
    return Error{fmt::format("--times: the source has no time there; its times: {}", steps.summary())};
  }
  return list.all();
}

Result<std::vector<UtcTime>> named_instants(const std::vector<std::string>& values, const TimeSteps& steps) {
  std::set<UtcTime> found;
  for (const std::string& value : values) {
    StepList one(steps);
    if (Status added = add_value(value, one, StepRule::named); !added) return added.error();
    const std::vector<UtcTime> named = one.all();
    if (named.empty()) {
      return Error{fmt::format("--times: there is nothing of {}; there is {}", in_quotes(value), steps.summary())};
    }
    found.insert(named.begin(), named.end());
  }
  return std::vector<UtcTime>(found.begin(), found.end());
}

Result<PreloadSource> source_at(const PreloadSource& source, UtcTime instant, const HttpOptions& http) {
  auto set = at_time(source.set, instant);
  if (!set) return set.error();
  return remote_preload_source(*std::move(set), http);
}

PreloadCommand command_at(const PreloadCommand& command, const std::string& time) {
  PreloadCommand one = command;
  const auto beside = [&time](const std::string& file) {
    std::error_code failed;
    const bool other = std::filesystem::exists(file, failed) && !std::filesystem::is_regular_file(file, failed);
    return file.empty() || other ? file : file_of_time(file, time).string();
  };
  one.output = file_of_time(command.output, time).string();
  one.missing_file = beside(command.missing_file);
  one.stored_file = beside(command.stored_file);
  return one;
}

void add(PreloadForecast& all, const PreloadForecast& one) {
  ++all.instants;
  all.there += one.there;
  for (const LevelCount& level : one.levels) {
    const auto same = std::ranges::find(all.levels, level.level, &LevelCount::level);
    if (same == all.levels.end()) {
      all.levels.push_back(level);
    } else {
      same->tiles += level.tiles;
    }
  }
  if (!all.no_room) all.no_room = one.no_room;
}

}  // namespace terrella
