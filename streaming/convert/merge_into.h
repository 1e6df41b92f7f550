#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "base/result.h"
#include "streaming/cache/merge_caches.h"

namespace terrella {

/// The tiles of caches of one source, each once, chosen as merge_caches() does; a TileLister, whose tiles can be read
/// when they were listed. A file beside `output` keeps the list. thread: one at a time
[[nodiscard]] std::shared_ptr<TileSource> merged_tiles(const std::vector<std::filesystem::path>& caches,
                                                       TileSetInfo info, const std::filesystem::path& output);

/// Merges caches of one source into an MBTiles or PMTiles file, with the tiles that merge_caches() would choose. Each
/// tile is read and written once. Validators, expiry and missing-tile records have no place in such a file. Fails if
/// the output exists, or cannot hold the tiles. Blocks. thread: any
[[nodiscard]] Result<MergeSummary> merge_into(const std::vector<std::filesystem::path>& caches,
                                              const std::filesystem::path& output, const MergeProgress& progress = {});

}  // namespace terrella
