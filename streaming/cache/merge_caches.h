#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

#include "base/result.h"

namespace terrella {

struct MergeSummary {
  std::int64_t tiles = 0;     ///< in the result
  std::int64_t absences = 0;  ///< in the result
  std::int64_t dropped = 0;   ///< records that others in the same place have won over
};

/// False: stop, leave nothing behind.
using MergeProgress = std::function<bool(std::int64_t done, std::int64_t total)>;

/// Joins caches of one source into one file, with validators, expiry, last use and absences. Of two records of one
/// place a tile wins over an absence, else the one stored later. What is pinned in one is pinned in the result. Caches
/// of different sources or grids are refused by name; levels may differ. The result is made beside `output` and takes
/// its name once it is whole, so an interrupted merge leaves nothing under that name and can be run again. What has the
/// name already is replaced only if it is one of the caches. thread: one at a time
[[nodiscard]] Result<MergeSummary> merge_caches(const std::vector<std::filesystem::path>& caches,
                                                const std::filesystem::path& output,
                                                const MergeProgress& progress = {});

}  // namespace terrella
