#pragma once

#include <chrono>
#include <functional>
#include <string>

#include "base/result.h"

namespace terrella {

/// The message of the last action, shown for the time that reading it takes. A fault stays until it is closed or
/// another message follows. thread: main
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
  /// Adds a line to the message if the last call reported a fault too; else replaces the message.
  void report(const std::string& problem);

  [[nodiscard]] const std::string& text() const { return text_; }
  [[nodiscard]] bool is_fault() const { return is_fault_; }
  bool close_fault();  ///< false if no fault is shown
  /// True if the message is still there after its time.
  [[nodiscard]] bool is_due() const { return !text_.empty() && !is_fault_ && Clock::now() >= until_; }
  void begin_frame();  ///< removes a message after its time
  void end_frame();    ///< acts, if the frame shows the message of say_then()
  /// Seconds until the message is due, at most `most_s`; `most_s` without a message.
  [[nodiscard]] double seconds_left(double most_s) const;

 private:
  std::string text_;
  bool is_fault_ = false;
  Clock::time_point until_{};
  std::function<void()> act_;  ///< may be empty
  bool act_shown_ = false;     ///< the frame shows its message
};

}  // namespace terrella
