#include "apps/viewer/timeline/joined_steps.h"

#include <fmt/chrono.h>

#include <algorithm>
#include <chrono>

namespace terrella {

UtcTime JoinedSteps::first() const {
  return (*std::ranges::min_element(layers_, {}, [](const auto& steps) { return steps->first(); }))->first();
}

UtcTime JoinedSteps::last() const {
  return (*std::ranges::max_element(layers_, {}, [](const auto& steps) { return steps->last(); }))->last();
}

std::optional<UtcTime> JoinedSteps::at_or_before(UtcTime time) const {
  std::optional<UtcTime> latest;
  for (const auto& steps : layers_) latest = std::max(latest, steps->at_or_before(time));
  return latest;
}

std::optional<UtcTime> JoinedSteps::before(UtcTime time) const { return at_or_before(time - UtcTime::duration(1)); }

std::optional<UtcTime> JoinedSteps::after(UtcTime time) const {
  std::optional<UtcTime> earliest;
  for (const auto& steps : layers_) {
    const auto next = steps->after(time);
    if (next && (!earliest || *next < *earliest)) earliest = next;
  }
  return earliest;
}

std::optional<UtcTime> next_step(const JoinedSteps& steps, UtcTime from, const StepPlay& play) {
  if (const auto next = play.backwards ? steps.before(from) : steps.after(from)) return next;
  if (!play.loops || steps.first() == steps.last()) return {};
  return play.backwards ? steps.last() : steps.first();
}

std::string step_text(UtcTime step, bool local) {
  using namespace std::chrono;
  if (step == floor<days>(step)) return fmt::format("{:%Y-%m-%d}", fmt::gmtime(system_clock::to_time_t(step)));
  const bool seconds = step != floor<minutes>(step);
  const std::time_t time = system_clock::to_time_t(step);
  const std::tm parts = local ? fmt::localtime(time) : fmt::gmtime(time);
  const std::string text =
      seconds ? fmt::format("{:%Y-%m-%d %H:%M:%S}", parts) : fmt::format("{:%Y-%m-%d %H:%M}", parts);
  return local ? text : text + " UTC";
}

}  // namespace terrella
