// Memory over a long flight: what the process holds after each leg, thirty lines of it, and at the end whether its
// peaks grew once the first part of the flight was over.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <exception>
#include <span>
#include <vector>

#include "tests/stability/memory_flight.h"

namespace {

using namespace terrella;
using test::MemoryFlight;
using test::MemorySample;
using Clock = std::chrono::steady_clock;

constexpr double kMegabyte = 1024.0 * 1024.0;

/// A sixth of the flight fills what has room.
constexpr double kFilling = 1.0 / 6.0;

void print(double minutes, const MemorySample& s) {
  fmt::print(
      "{:6.1f} min {:8} frames  resident {:7.1f} MB  heap {:7.1f} MB  slots {:5.1f} MB  heights {:4.1f} MB  patches "
      "{:6}  tiles {:6}  waiting {:4}  uncovered {}\n",
      minutes, s.frames, s.resident_mb, s.heap_mb, static_cast<double>(s.last.gpu_bytes) / kMegabyte,
      static_cast<double>(s.last.height_bytes) / kMegabyte, s.most_held, s.most_known, s.finished, s.uncovered);
  std::fflush(stdout);
}

/// The greatest of each tenth of the flight that counts, against their mean: what fills up and empties again on the way
/// is no growth.
void print_peaks(const char* what, const std::vector<double>& mb) {
  constexpr std::size_t kParts = 10;
  std::vector<double> peaks;
  for (std::size_t k = 0; k < kParts; ++k) {
    const auto part =
        std::span(mb).subspan(k * mb.size() / kParts, (k + 1) * mb.size() / kParts - k * mb.size() / kParts);
    if (!part.empty()) peaks.push_back(std::ranges::max(part));
  }
  if (peaks.empty()) return;
  double mean = 0.0;
  for (const double peak : peaks) mean += peak / static_cast<double>(peaks.size());
  fmt::print("{}: peaks of {} parts {:.1f} MB", what, peaks.size(), mean);
  for (const double peak : peaks) fmt::print(" {:+.1f} %", 100.0 * (peak / mean - 1.0));
  fmt::print("\n");
}

int fly(double minutes, int side_px) {
  const auto context = HeadlessContext::create();
  if (!context) return fmt::print(stderr, "{}\n", context.error().message), 1;
  MemoryFlight flight({side_px, side_px}, 40, 1);
  std::vector<double> resident_mb, heap_mb;
  const auto start = Clock::now();
  for (double next = 0.0, now = 0.0; now < minutes;) {
    const MemorySample sample = flight.fly();
    now = std::chrono::duration<double, std::ratio<60>>(Clock::now() - start).count();
    if (now >= next) print(now, sample);
    if (now >= next) next += std::max(0.1, minutes / 30.0);
    if (now < kFilling * minutes) continue;
    resident_mb.push_back(sample.resident_mb);
    heap_mb.push_back(sample.heap_mb);
  }
  print_peaks("resident", resident_mb);
  print_peaks("heap", heap_mb);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Memory over a long flight: orbit, streets, poles, ±180°, heights, layers that come and go");
  double minutes = 30.0;
  int side_px = 128;
  app.add_option("--minutes", minutes, "how long")->check(CLI::Range(0.1, 1e4));
  app.add_option("--size", side_px, "the picture's side, pixels")->check(CLI::Range(1, 4096));
  CLI11_PARSE(app, argc, argv);
  try {
    return fly(minutes, side_px);
  } catch (const std::exception& error) {
    fmt::print(stderr, "memory_flight: {}\n", error.what());
    return 1;
  }
}
