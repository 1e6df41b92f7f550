#pragma once

#include <filesystem>
#include <vector>

#include "base/result.h"
#include "streaming/cache/merge_caches.h"

namespace terrella {

/// Merges caches of one source into an MBTiles or PMTiles file, with the tiles that merge_caches() would choose. Each
/// tile is read and written once. Validators, expiry and missing-tile records have no place in such a file. Fails if
/// the output exists, or cannot hold the tiles. Blocks. thread: any
[[nodiscard]] Result<MergeSummary> merge_into(const std::vector<std::filesystem::path>& caches,
                                              const std::filesystem::path& output, const MergeProgress& progress = {});

}  // namespace terrella
