#include "apps/process/progress.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "apps/process/console.h"

namespace terrella {

Progress::Progress(std::string what) : what_(one_line(what)), terminal_(isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  if (line_open_) fmt::print(stderr, "\n");
}

void Progress::show(std::int64_t done, std::int64_t total) {
  if (CapturedConsole::active()) return;
  const double part = total > 0 ? std::clamp(static_cast<double>(done) / static_cast<double>(total), 0.0, 1.0) : 1.0;
  if (terminal_) {
    draw_bar(part);
    return;
  }
  const int tenth = static_cast<int>(part * 10.0);
  if (tenth == last_tenth_) return;
  last_tenth_ = tenth;
  fmt::print(stderr, "{}: {} %\n", what_, tenth * 10);
}

void Progress::draw_bar(double part) {
  constexpr auto kBetween = std::chrono::milliseconds(50);
  constexpr int kCells = 40;
  const auto now = std::chrono::steady_clock::now();
  if (part < 1.0 && now - last_drawn_ < kBetween) return;
  last_drawn_ = now;
  const int full = static_cast<int>(part * kCells);
  fmt::print(stderr, "\r{} [{:#<{}}{:.<{}}] {:3.0f} %", what_, "", full, "", kCells - full, part * 100.0);
  std::fflush(stderr);
  line_open_ = true;
}

}  // namespace terrella
