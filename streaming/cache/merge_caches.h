#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

#include "base/result.h"
#include "streaming/cache/cache_report.h"

namespace terrella {

struct MergeSummary {
  std::int64_t tiles = 0;    ///< tiles in the result
  std::int64_t missing = 0;  ///< missing-tile records in the result
  std::int64_t dropped = 0;  ///< records that lost against another record of the same place
};

/// Returns false to stop the merge; nothing is left behind.
using MergeProgress = std::function<bool(std::int64_t done, std::int64_t total)>;

/// Sums of the caches, with the levels of all. Fails, by name, for caches of different sources or grids. thread: any
[[nodiscard]] Result<CacheReport> report_together(const std::vector<std::filesystem::path>& caches);

/// Merges caches of one source into one file, with validators, expiry, last use and missing-tile records.
/// If two caches have a record of one place, a tile wins over a missing-tile record, otherwise the record stored later
/// wins. A tile pinned in any cache is pinned in the result. Caches of different sources or grids are refused by name;
/// levels may differ. The result is written beside `output` and gets that name when it is complete. An interrupted
/// merge leaves nothing under that name and can be repeated. An existing file of that name is replaced only if it is
/// one of the caches. thread: one at a time
[[nodiscard]] Result<MergeSummary> merge_caches(const std::vector<std::filesystem::path>& caches,
                                                const std::filesystem::path& output,
                                                const MergeProgress& progress = {});

}  // namespace terrella
