#pragma once

#include <string>
#include <vector>

#include "apps/preload/preload_options.h"
#include "apps/preload/preload_report.h"
#include "apps/preload/preload_source.h"
#include "base/result.h"
#include "base/time_steps.h"

namespace terrella {

/// Most instants of one command. Each has a cache of its own.
inline constexpr std::size_t kMostPreloadTimes = 10000;

/// Lists the steps that values of --times name, earliest first, each once: an instant A is the last step at or before
/// it; A/B/PERIOD are those of its instants; A/B are all steps from A to the end of B, which may be "now". The error
/// names the value, and the first step if a value is before it. thread: any
[[nodiscard]] Result<std::vector<UtcTime>> preload_instants(const std::vector<std::string>& values,
                                                            const TimeSteps& steps);

/// Lists the steps that values of --times name themselves: those within a named moment, day or month, within A/B, and
/// the instants of A/B/PERIOD. The error names a value without any. thread: any
[[nodiscard]] Result<std::vector<UtcTime>> named_instants(const std::vector<std::string>& values,
                                                          const TimeSteps& steps);

/// The source at one of its instants. thread: any
[[nodiscard]] Result<PreloadSource> source_at(const PreloadSource& source, UtcTime instant, const HttpOptions& http);

/// The command for one instant: cache and lists are files beside those that are named (file_of_time()). Lists that are
/// no regular files, such as /dev/null, stay. thread: any
[[nodiscard]] PreloadCommand command_at(const PreloadCommand& command, const std::string& time);

/// Adds the counts of another instant to a forecast; sample and rate stay those of the first. thread: any
void add(PreloadForecast& all, const PreloadForecast& one);

}  // namespace terrella
