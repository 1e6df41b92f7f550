#pragma once

#include <algorithm>
#include <glm/vec2.hpp>
#include <optional>

#include "view/flight.h"

namespace terrella {

/// Tells when the pointer has rested at a place for a moment. thread: any, but one call at a time
class PointerRest {
 public:
  static constexpr Seconds kMoment{0.4};

  /// Takes the pointer's place at a time; nullopt if the pointer cannot rest now. Call this once per frame.
  void follow(std::optional<glm::dvec2> at_px, Seconds now) {
    if (at_px == at_px_) return;
    at_px_ = at_px;
    since_ = now;
    told_ = false;
  }
  /// True if the pointer rests and take() has not told this.
  [[nodiscard]] bool is_due(Seconds now) const { return at_px_ && !told_ && now - since_ >= kMoment; }
  /// Returns the place once, when it is due.
  [[nodiscard]] std::optional<glm::dvec2> take(Seconds now) {
    if (!is_due(now)) return std::nullopt;
    told_ = true;
    return at_px_;
  }
  /// True from take() until the pointer moves.
  [[nodiscard]] bool is_told() const { return told_; }
  /// Ends the rest at this place, which take() does not tell any more.
  void hush() { told_ = true; }
  /// Seconds until the pointer has rested, at most `most_s`; `most_s` if it does not rest.
  [[nodiscard]] double seconds_left(Seconds now, double most_s) const {
    if (!at_px_ || told_) return most_s;
    return std::clamp((since_ + kMoment - now).count(), 0.0, most_s);
  }

 private:
  std::optional<glm::dvec2> at_px_;
  Seconds since_{0.0};
  bool told_ = false;
};

}  // namespace terrella
