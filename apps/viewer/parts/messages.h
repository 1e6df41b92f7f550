#pragma once

#include <chrono>
#include <functional>
#include <string>

namespace terrella {

/// The message of the last action, shown for the time that reading it takes. thread: main
class Messages {
 public:
  using Clock = std::chrono::steady_clock;

  /// Secrets of addresses in a text are not shown (streaming/url.h).
  void say(const std::string& text);
  void say(const std::string& text, Clock::duration time);
  /// Shows a message, and calls `act` once a frame shows the message: for an action whose next frame takes seconds.
  void say_then(const std::string& text, std::function<void()> act);
  [[nodiscard]] bool has_waiting() const { return act_ != nullptr; }
  /// Adds a line to the message if the last call reported a problem too; else replaces the message.
  void report(const std::string& problem);

  [[nodiscard]] const std::string& text() const { return text_; }
  /// True if the message is still there after its time.
  [[nodiscard]] bool is_due() const { return !text_.empty() && Clock::now() >= until_; }
  void begin_frame();  ///< removes a message after its time
  void end_frame();    ///< acts, if the frame shows the message of say_then()
  /// Seconds until the message is due, at most `most_s`; `most_s` without a message.
  [[nodiscard]] double seconds_left(double most_s) const;

 private:
  std::string text_;
  std::string problems_;  ///< problems reported one after another
  Clock::time_point until_{};
  std::function<void()> act_;  ///< may be empty
  bool act_shown_ = false;     ///< the frame shows its message
};

}  // namespace terrella
