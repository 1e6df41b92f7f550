#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/commands/lack_report.h"
#include "streaming/preload/preloader.h"
#include "streaming/preload/sample_size.h"
#include "streaming/preload/tile_plan.h"

namespace terrella {

/// What a preload came to.
struct PreloadReport {
  std::string output;
  PreloadResult result;
  std::vector<LackReport::Group> lacking;
  double seconds = 0.0;
};
/// For people: lines of text, at most twenty reasons. For programs: one JSON object.
[[nodiscard]] std::string to_text(const PreloadReport& report);
[[nodiscard]] std::string to_json(const PreloadReport& report);

/// What --release came to, for programs.
struct ReleaseReport {
  std::string output;
  std::int64_t released = 0;
};
[[nodiscard]] std::string to_json(const ReleaseReport& report);

/// What a preload would come to.
struct PreloadForecast {
  std::vector<LevelCount> levels;
  std::int64_t there = 0;  ///< in the cache already, fresh
  SizeSample sample;
  double rate = 0.0;  ///< requests a second; 0: no limit
  int jobs = 1;
  std::optional<Error> no_room;  ///< why the cache's limit is too small for it
};
[[nodiscard]] std::string to_text(const PreloadForecast& forecast);
[[nodiscard]] std::string to_json(const PreloadForecast& forecast);

}  // namespace terrella
