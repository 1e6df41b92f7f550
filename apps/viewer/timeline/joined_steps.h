#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/time_steps.h"

// thread: any, for all of this header
namespace terrella {

/// The instants of several layers as one row of instants: a step is an instant of at least one layer.
class JoinedSteps {
 public:
  /// `layers`: not null, not empty.
  explicit JoinedSteps(std::vector<std::shared_ptr<const TimeSteps>> layers) : layers_(std::move(layers)) {}

  [[nodiscard]] bool empty() const { return layers_.empty(); }
  [[nodiscard]] UtcTime first() const;
  [[nodiscard]] UtcTime last() const;
  // Nothing if there is no such step.
  [[nodiscard]] std::optional<UtcTime> at_or_before(UtcTime time) const;
  [[nodiscard]] std::optional<UtcTime> before(UtcTime time) const;
  [[nodiscard]] std::optional<UtcTime> after(UtcTime time) const;

 private:
  std::vector<std::shared_ptr<const TimeSteps>> layers_;
};

/// The direction and the end of a play.
struct StepPlay {
  bool backwards = false;
  bool loops = true;
};

/// The step that follows in play: after the end the other end if the play loops, else nothing. Nothing too if there is
/// one step alone.
[[nodiscard]] std::optional<UtcTime> next_step(const JoinedSteps& steps, UtcTime from, const StepPlay& play);

/// Writes an instant in UTC or in the time zone of the user: "2026-06-21", "2026-06-21 12:00 UTC", "2026-06-21 14:00".
/// Midnight in UTC is a date alone, which is the same in any zone: services write days so.
[[nodiscard]] std::string step_text(UtcTime step, bool local);

}  // namespace terrella
