#include "streaming/remote/wmts/wmts_time.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "streaming/remote/tile_set_time.h"

namespace terrella {
namespace {

/// True if a time is a value, or begins within a series. It need not be one of the instants of the series.
bool is_listed(const WmtsDimension& dimension, const TimeSteps& steps, const std::string& time) {
  if (std::ranges::find(dimension.values, time) != dimension.values.end()) return true;
  const auto wanted = read_named_time(time);
  return wanted && std::ranges::any_of(steps.series(), [&wanted](const TimeSeries& one) {
           return wanted->from >= one.first && wanted->from < end_of(one);
         });
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
  using std::chrono::floor;
  const UtcTime now = floor<std::chrono::milliseconds>(std::chrono::system_clock::now());
  Result<TimeSteps> read = TimeSteps::parse(dimension.values, now);
  ChosenTime chosen{.value = value};
  if (read) {
    chosen.steps = *std::move(read);
  } else {
    chosen.fault = read.error().message;
  }
  const bool check = !given.empty() && given != dimension.otherwise && !dimension.values.empty();
  if (check && !is_listed(dimension, chosen.steps, value)) {
    const std::string why = chosen.fault.empty() ? "" : "; " + chosen.fault;
    return Error{fmt::format("it has nothing at ‹time› {} ({}{})", value, list_of(dimension), why)};
  }
  chosen.newest = is_newest(chosen.steps, value);
  return chosen;
}

void set_times(ChosenTime chosen, RemoteTileSet& set) {
  set.info.time = std::move(chosen.value);
  if (!chosen.fault.empty()) set.info.remarks.push_back("its times: " + chosen.fault);
  set_steps(std::move(chosen.steps), set.info);
}

}  // namespace terrella
