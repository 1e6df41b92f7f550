#include "apps/preload/preload_progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "apps/process/console.h"

namespace terrella {

PreloadProgress::PreloadProgress(std::string hours) : hours_(std::move(hours)), terminal_(isatty(STDERR_FILENO) == 1) {}

PreloadProgress::~PreloadProgress() {
  if (line_open_) fmt::print(stderr, "\n");
}

void PreloadProgress::show(const PreloadCounts& counts) {
  const bool waits = counts.waits.count() > 0;
  if (waits && !std::exchange(told_wait_, true) && (!terminal_ || CapturedConsole::active())) {
    print_message("terrella preload: {}\n", wait_text(counts));
  }
  if (!waits) told_wait_ = false;
  if (CapturedConsole::active()) return;
  const auto now = Clock::now();
  measure(counts, now);
  if (terminal_) {
    constexpr const char* kEraseToEnd = "\x1b[K";
    fmt::print(stderr, "\r{}{}", line(counts), kEraseToEnd);
    std::fflush(stderr);
    line_open_ = true;
    return;
  }
  if (waits) return;
  // The first line comes after 1 s, later lines at most every 2 s, with at most twenty lines per tenfold time.
  const auto between = std::max<Clock::duration>(std::chrono::seconds(2), (now - begun_) / 10);
  if (now - begun_ < std::chrono::seconds(1) || (told_ != begun_ && now - told_ < between)) return;
  told_ = now;
  fmt::print(stderr, "{}\n", line(counts));
}

// Updates the rate. Tiles already in the cache pass too fast to predict the remaining time, so they do not count.
void PreloadProgress::measure(const PreloadCounts& counts, Clock::time_point now) {
  constexpr double kSmoothing_s = 5.0;
  const double seconds = std::chrono::duration<double>(now - measured_).count();
  if (seconds <= 0.0) return;
  // A lock or a wait says nothing about the rate.
  if (counts.locked || counts.waits.count() > 0) {
    measured_ = now;
    return;
  }
  const std::int64_t asked = counts.passed - counts.there;
  const double rate = static_cast<double>(asked - asked_measured_) / seconds;
  // A running mean without an initial value: the observations so far stand for all.
  const double kept = std::exp(-seconds / kSmoothing_s);
  tiles_seen_ = kept * tiles_seen_ + (1.0 - kept) * rate;
  weight_seen_ = kept * weight_seen_ + (1.0 - kept);
  asked_measured_ = asked;
  measured_ = now;
}

std::string PreloadProgress::wait_text(const PreloadCounts& counts) const {
  return fmt::format("outside of --between {}; waiting {}", hours_, duration_text(double(counts.waits.count())));
}

std::string PreloadProgress::line(const PreloadCounts& counts) const {
  const double part =
      counts.planned > 0 ? static_cast<double>(counts.passed) / static_cast<double>(counts.planned) : 1.0;
  std::string text = fmt::format("{:.1f} % of {} tiles: {} stored ({}), {} there already", part * 100.0, counts.planned,
                                 counts.stored, bytes_text(static_cast<double>(counts.stored_bytes)), counts.there);
  if (counts.missing() > 0) text += fmt::format(", {} missing", counts.missing());
  if (counts.locked) return text + "; the cache is locked by another program, waiting for it";
  if (counts.waits.count() > 0) return text + "; " + wait_text(counts);
  const double tiles_per_s = weight_seen_ > 0.0 ? tiles_seen_ / weight_seen_ : 0.0;
  if (tiles_per_s >= 0.05) {
    text += fmt::format("; {:.0f} tiles/s, {} left", tiles_per_s,
                        duration_text(static_cast<double>(counts.planned - counts.passed) / tiles_per_s));
  }
  return text;
}

std::string duration_text(double seconds) {
  if (seconds < 1.0) return fmt::format("{:.1f} s", seconds);
  if (seconds < 120.0) return fmt::format("{:.0f} s", seconds);
  const double minutes = seconds / 60.0;
  if (minutes < 120.0) return fmt::format("{:.0f} min", minutes);
  const double hours = std::floor(minutes / 60.0);
  if (hours < 72.0) return fmt::format("{:.0f} h {:.0f} min", hours, std::floor(minutes - 60.0 * hours));
  return fmt::format("{:.1f} days", minutes / 1440.0);
}

std::string bytes_text(double bytes) {
  if (bytes >= 1e12) return fmt::format("{:.1f} TB", bytes * 1e-12);
  if (bytes >= 1e9) return fmt::format("{:.1f} GB", bytes * 1e-9);
  if (bytes >= 1e6) return fmt::format("{:.1f} MB", bytes * 1e-6);
  return fmt::format("{:.0f} kB", bytes * 1e-3);
}

}  // namespace terrella
