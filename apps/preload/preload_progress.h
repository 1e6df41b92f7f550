#pragma once

#include <chrono>
#include <string>

#include "streaming/preload/preloader.h"

namespace terrella {

/// Tells how far a preload is, on standard error: one line that is drawn over on a terminal, else a line now and then,
/// the fewer the longer it takes. Has the rate of the last seconds and the time left at that rate. thread: one at a
/// time
class PreloadProgress {
 public:
  PreloadProgress();
  ~PreloadProgress();  ///< ends the terminal's line
  PreloadProgress(const PreloadProgress&) = delete;
  PreloadProgress& operator=(const PreloadProgress&) = delete;

  void show(const PreloadCounts& counts);

 private:
  using Clock = std::chrono::steady_clock;

  [[nodiscard]] std::string line(const PreloadCounts& counts) const;
  void measure(const PreloadCounts& counts, Clock::time_point now);

  bool terminal_;
  bool line_open_ = false;
  Clock::time_point begun_ = Clock::now();
  Clock::time_point measured_ = begun_;
  Clock::time_point told_ = begun_;
  std::int64_t asked_measured_ = 0;
  double tiles_seen_ = 0.0;  ///< a second, of those that had to be asked for, times weight_seen_
  double weight_seen_ = 0.0;
};

/// "2 h 5 min", "40 s".
[[nodiscard]] std::string duration_text(double seconds);
/// "1.2 GB", "840 kB".
[[nodiscard]] std::string bytes_text(double bytes);

}  // namespace terrella
