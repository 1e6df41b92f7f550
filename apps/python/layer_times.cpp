#include "apps/python/layer_times.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <memory>

namespace terrella {
namespace {

constexpr std::int64_t kMostListedTimes = 100'000;

}  // namespace

Status go_to_time(Globe& globe, LayerId layer, const std::string& time) {
  const auto instant = parse_utc(time);
  if (!instant) return instant.error();
  return globe.set_layer_time(layer, *instant);
}

Result<std::optional<std::string>> shown_time(const Globe& globe, LayerId layer) {
  const auto source = globe.source(layer);
  if (!source) return source.error();
  const std::string& time = (*source)->info().time;
  return time.empty() ? std::nullopt : std::optional(time);
}

Result<std::vector<std::string>> listed_times(const Globe& globe, LayerId layer) {
  const auto source = globe.source(layer);
  if (!source) return source.error();
  std::vector<std::string> times;
  const auto& steps = (*source)->info().steps;
  if (!steps) return times;
  if (steps->count() > kMostListedTimes) {
    return Error{
        fmt::format("{} has more than {} times: {}", (*source)->info().name, kMostListedTimes, steps->summary())};
  }
  std::vector<UtcTime> instants;
  instants.reserve(static_cast<std::size_t>(steps->count()));
  for (const TimeSeries& series : steps->series()) {
    for (std::int64_t i = 0; i < series.count; ++i) {
      instants.push_back(i == 0 ? series.first : after_periods(series.first, series.period, i));
    }
  }
  std::ranges::sort(instants);
  const auto end = std::unique(instants.begin(), instants.end());
  times.reserve(instants.size());
  std::transform(instants.begin(), end, std::back_inserter(times), [&](UtcTime step) { return steps->text(step); });
  return times;
}

}  // namespace terrella
