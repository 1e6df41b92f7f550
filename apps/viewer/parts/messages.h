#pragma once

#include <chrono>
#include <string>

namespace terrella {

/// The message of the last action, shown for the time that reading it takes. thread: main
class Messages {
 public:
  using Clock = std::chrono::steady_clock;

  void say(std::string text);
  void say(std::string text, Clock::duration time);
  /// Adds a line to the message if the last call reported a problem too; else replaces the message.
  void report(const std::string& problem);

  [[nodiscard]] const std::string& text() const { return text_; }
  /// True if the message is still there after its time.
  [[nodiscard]] bool is_due() const { return !text_.empty() && Clock::now() >= until_; }
  void drop_due();  ///< removes a message after its time
  /// Seconds until the message is due, at most `most_s`; `most_s` without a message.
  [[nodiscard]] double seconds_left(double most_s) const;

 private:
  std::string text_;
  std::string problems_;  ///< problems reported one after another
  Clock::time_point until_{};
};

}  // namespace terrella
