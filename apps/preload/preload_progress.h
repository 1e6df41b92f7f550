#pragma once

#include <chrono>
#include <string>

#include "streaming/preload/preloader.h"

namespace terrella {

/// Shows a preload's progress on standard error: one line redrawn on a terminal, else plain lines that become rarer
/// with time. A wait for the hours is told once, or stands in the redrawn line. Each line has the recent rate and the
/// remaining time at that rate. thread: one at a time
class PreloadProgress {
 public:
  /// `hours`: a text for the time when requests may be sent; empty: always.
  explicit PreloadProgress(std::string hours = {});
  ~PreloadProgress();  ///< ends the terminal's line
  PreloadProgress(const PreloadProgress&) = delete;
  PreloadProgress& operator=(const PreloadProgress&) = delete;

  void show(const PreloadCounts& counts);

 private:
  using Clock = std::chrono::steady_clock;

  [[nodiscard]] std::string wait_text(const PreloadCounts& counts) const;
  [[nodiscard]] std::string line(const PreloadCounts& counts) const;
  void measure(const PreloadCounts& counts, Clock::time_point now);

  const std::string hours_;
  bool terminal_;
  bool told_wait_ = false;
  bool line_open_ = false;
  Clock::time_point begun_ = Clock::now();
  Clock::time_point measured_ = begun_;
  Clock::time_point told_ = begun_;
  std::int64_t asked_measured_ = 0;
  double tiles_seen_ = 0.0;  ///< tiles requested per second, times weight_seen_
  double weight_seen_ = 0.0;
};

/// Formats a duration: "2 h 5 min", "40 s".
[[nodiscard]] std::string duration_text(double seconds);
/// Formats a size: "1.2 GB", "840 kB".
[[nodiscard]] std::string bytes_text(double bytes);

}  // namespace terrella
