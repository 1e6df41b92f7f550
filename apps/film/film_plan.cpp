#include "apps/film/film_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace terrella {
namespace {

constexpr double kMostFrames = 1e6;

}  // namespace

Result<FilmPlan> FilmPlan::make(std::vector<FlightPath> paths, double fps) {
  FilmPlan plan(std::move(paths), fps);
  const double lasts_s = duration_s(plan.paths_);
  const double frames = std::round(lasts_s * fps);
  if (!(frames <= kMostFrames)) {
    return Error{
        fmt::format("the flight lasts {:.6g} s, which is {:.0f} frames; a film has at most {:.0f}: give it a shorter "
                    "duration_s, or "
                    "fewer --fps",
                    lasts_s, frames, kMostFrames)};
  }
  plan.frames_ = std::max<std::int64_t>(1, static_cast<std::int64_t>(frames));
  return plan;
}

FlightMoment FilmPlan::moment(std::int64_t frame, double later_s) const {
  return moment_at(paths_, static_cast<double>(frame) / fps_, later_s);
}

std::vector<FlightMoment> FilmPlan::moments(std::int64_t frame, double shutter, int count) const {
  if (shutter == 0.0) return {moment(frame)};
  std::vector<FlightMoment> all;
  all.reserve(static_cast<std::size_t>(count));
  for (int k = 0; k < count; ++k) all.push_back(moment(frame, ((k + 0.5) / count - 0.5) * shutter / fps_));
  return all;
}

std::optional<UtcTime> FilmPlan::first_sun() const {
  for (const FlightPath& path : paths_) {
    if (const auto sun = path.at(0.0).sun) return sun;
  }
  return std::nullopt;
}

}  // namespace terrella
