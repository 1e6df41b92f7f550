#pragma once

#include <chrono>
#include <functional>
#include <string>

#include "base/result.h"

namespace terrella {

/// The message of the last action, shown for the time that reading it takes, under the last fault, which stays until it
/// is closed or another one follows. thread: main
class Messages {
 public:
  using Clock = std::chrono::steady_clock;

  /// Secrets of addresses in a text are not shown (streaming/url.h).
  void say(const std::string& text);
  void say(const std::string& text, Clock::duration time);
  void say(const Error& fault);
  /// Shows a message, and calls `act` once a frame shows the message: for an action whose next frame takes seconds.
  void say_then(const std::string& text, std::function<void()> act);
  [[nodiscard]] bool has_waiting() const { return act_ != nullptr; }
  /// Adds a line to the fault that is shown, if it does not have it yet.
  void report(const std::string& problem);

  /// The fault and the message, one a line; maybe empty.
  [[nodiscard]] std::string text() const;
  [[nodiscard]] bool has_fault() const { return !fault_.empty(); }
  bool close_fault();  ///< false if no fault is shown
  /// True if the message is still there after its time.
  [[nodiscard]] bool is_due() const { return !text_.empty() && Clock::now() >= until_; }
  void begin_frame();  ///< removes a message after its time
  void end_frame();    ///< acts, if the frame shows the message of say_then()
  /// Seconds until the message is due, at most `most_s`; `most_s` without a message.
  [[nodiscard]] double seconds_left(double most_s) const;

 private:
  std::string text_;   ///< without the fault
  std::string fault_;  ///< empty: none
  Clock::time_point until_{};
  std::function<void()> act_;  ///< may be empty
  bool act_shown_ = false;     ///< the frame shows its message
};

}  // namespace terrella
