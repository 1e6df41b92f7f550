#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace terrella {

/// Shows a long job's progress on standard error: a redrawn bar on a terminal, else a plain line at every tenth part.
/// Output is rate-limited, so show() may be called for every row. thread: one at a time
class Progress {
 public:
  /// `what` precedes the figures, for example "cutting moon.jpg".
  explicit Progress(std::string what);
  ~Progress();  ///< ends the bar's line
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void show(std::int64_t done, std::int64_t total);

 private:
  void draw_bar(double part);

  std::string what_;
  bool terminal_;
  bool line_open_ = false;
  int last_tenth_ = -1;
  std::chrono::steady_clock::time_point last_drawn_{};
};

}  // namespace terrella
