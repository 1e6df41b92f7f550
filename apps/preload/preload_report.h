#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/preload/missing_report.h"
#include "streaming/preload/preloader.h"
#include "streaming/preload/sample_size.h"
#include "streaming/preload/tile_plan.h"

namespace terrella {

/// Result of a preload.
struct PreloadReport {
  std::string output;
  std::string time;  ///< Time of the tiles; empty if only one time is preloaded.
  PreloadResult result;
  std::vector<MissingReport::Group> missing;
  double seconds = 0.0;
};
/// to_text() gives lines of text with at most twenty reasons, for people. to_json() gives one JSON object.
[[nodiscard]] std::string to_text(const PreloadReport& report);
[[nodiscard]] std::string to_json(const PreloadReport& report);
/// One JSON object for several instants: their reports, and the sums of planned, stored, there and requests.
[[nodiscard]] std::string to_json(const std::vector<PreloadReport>& instants);

/// Result of --release, for programs.
struct ReleaseReport {
  std::string output;
  std::int64_t released = 0;
};
[[nodiscard]] std::string to_json(const ReleaseReport& report);
/// One JSON object for several instants: their reports, and the sum of `released`.
[[nodiscard]] std::string to_json(const std::vector<ReleaseReport>& instants);

/// Estimate of a preload.
struct PreloadForecast {
  std::vector<LevelCount> levels;
  std::size_t instants = 0;  ///< Number of times; 0 if only one time is preloaded.
  std::int64_t there = 0;    ///< fresh tiles already in the cache
  SizeSample sample;
  double rate = 0.0;  ///< requests per second; 0: no limit
  int jobs = 1;
  std::optional<Error> no_room;  ///< set if the cache's limit is too small for the plan
};
[[nodiscard]] std::string to_text(const PreloadForecast& forecast);
[[nodiscard]] std::string to_json(const PreloadForecast& forecast);

}  // namespace terrella
