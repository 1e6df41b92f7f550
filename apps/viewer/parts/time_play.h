#pragma once

#include <optional>

#include "apps/viewer/parts/part.h"
#include "view/navigation.h"

namespace terrella {

/// Lets the time of Sun, Moon and stars run. Owns the speed. thread: main
class TimePlay : public Part {
 public:
  explicit TimePlay(const ViewerContext& context) : Part(context) {}

  [[nodiscard]] bool is_playing() const { return playing_; }
  /// Plays or pauses. Without a time, playing begins with the present.
  void play(bool on);
  /// Seconds of the sky per second, positive.
  [[nodiscard]] double speed() const { return speed_; }
  void set_speed(double speed) { speed_ = speed; }
  /// Moves the globe's time on, if it is time for a step. Call it once per frame.
  void advance(Seconds now);

  [[nodiscard]] bool changed() const override;
  /// Seconds until the next step, at most `most_s`; `most_s` while pausing.
  [[nodiscard]] double seconds_left(double most_s) const;

 private:
  void start();
  [[nodiscard]] double step_s() const;

  bool playing_ = false;
  double speed_ = 600.0;
  Seconds stepped_{0.0};  ///< time of the last step
};

/// Shown before a time is first set: the next frame makes shader programs, which may take seconds.
inline constexpr const char* kTimeMessage = "Preparing Sun, Moon and stars ...";

/// The present, in whole minutes.
[[nodiscard]] UtcTime present_time();

}  // namespace terrella
