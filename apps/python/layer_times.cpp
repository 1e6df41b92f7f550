#include <fmt/format.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <memory>

#include "apps/open_scene/options/option_words.h"
#include "apps/python/python_globe.h"
#include "base/iso_time.h"

namespace terrella {
namespace {

constexpr std::int64_t kMostListedTimes = 100'000;

Status go_to_time(Globe& globe, LayerId layer, const std::string& time) {
  const auto instant = parse_utc(time);
  if (!instant) return instant.error();
  return globe.set_layer_time(layer, *instant);
}

Result<std::optional<std::string>> shown_time(const Globe& globe, LayerId layer) {
  const auto source = globe.source(layer);
  if (!source) return source.error();
  const auto shown = globe.layer_time(layer);
  if (!shown) return shown.error();
  if ((*source)->info().instant && !shown->shown) return std::optional<std::string>();
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

std::optional<std::string> time_of_globe(PythonGlobe& self) {
  const auto time = self.with_globe([](Globe& globe) { return globe.options().time; });
  return time ? std::optional(time_text(*time, TimePrecision::second, true)) : std::nullopt;
}

void set_time_of_globe(PythonGlobe& self, const std::optional<std::string>& text) {
  std::optional<UtcTime> time;
  if (text) time = value_or_raise(parse_utc(*text));
  value_or_raise(self.with_globe([&](Globe& globe) { return globe.set_time(time); }));
}

void set_layer_clock(PythonGlobe& self, std::uint64_t layer, const std::string& clock) {
  const LayerClock chosen = value_of_word("clock", clock, clock_words());
  change_look(self, layer, [chosen](ImageLook& look) { look.clock = chosen; });
}

}  // namespace

void add_time_methods(GlobeClass& globe) {
  globe
      .def_property(
          "time", &time_of_globe, &set_time_of_globe,
          "Time in UTC of Sun, Moon and stars, such as '2026-06-21T12:00:00Z'; None: the light comes over the "
          "viewer's shoulder.")
      .def(
          "set_layer_time",
          [](PythonGlobe& self, std::uint64_t layer, const std::string& time) {
            value_or_raise(self.with_globe([&](Globe& g) { return go_to_time(g, LayerId{layer}, time); }));
          },
          py::arg("layer"), py::arg("time"),
          "set_layer_time(self, layer, time)\n--\n\n"
          "Show a layer of imagery at a time in UTC, such as '2012-05-09' or '2012-05-09T12:00Z': at its last time at "
          "or before that. The next view has it.")
      .def("set_layer_clock", &set_layer_clock, py::arg("layer"), py::arg("clock"),
           "set_layer_clock(self, layer, clock)\n--\n\n"
           "Choose the dates of a layer of imagery. 'own': set_layer_time() chooses. 'globe': the last date at or "
           "before the globe's time. 'globe-fades': that one, and the next date fades in over it.")
      .def(
          "layer_time",
          [](PythonGlobe& self, std::uint64_t layer) {
            return value_or_raise(self.with_globe([&](Globe& g) { return shown_time(g, LayerId{layer}); }));
          },
          py::arg("layer"),
          "layer_time(self, layer)\n--\n\n"
          "The time that a layer of imagery shows, as its service writes it; None if it has no time.")
      .def(
          "layer_times",
          [](PythonGlobe& self, std::uint64_t layer) {
            return value_or_raise(self.with_globe([&](Globe& g) { return listed_times(g, LayerId{layer}); }));
          },
          py::arg("layer"),
          "layer_times(self, layer)\n--\n\n"
          "All times of a layer of imagery, earliest first; empty if it has none.");
}

}  // namespace terrella
