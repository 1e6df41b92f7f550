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

FlightMoment FilmPlan::moment(std::int64_t frame) const { return moment_at(paths_, static_cast<double>(frame) / fps_); }

std::optional<UtcTime> FilmPlan::first_sun() const {
  for (const FlightPath& path : paths_) {
    if (const auto sun = path.at(0.0).sun) return sun;
  }
  return std::nullopt;
}

}  // namespace terrella
