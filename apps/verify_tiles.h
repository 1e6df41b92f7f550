#pragma once

#include <filesystem>
#include <functional>
#include <memory>

#include "apps/tile_set_report.h"

namespace terrella {

/// Reads and decodes every tile within the bounds, on several threads. `progress` is called from time to time with
/// tiles asked for so far and in all. thread: main
[[nodiscard]] VerifyReport verify_tiles(const std::shared_ptr<TileSource>& source,
                                        const std::function<void(std::int64_t done, std::int64_t total)>& progress);
/// The same for the tiles that a cache holds, which are `total` or so: what it lacks is not counted as absent.
[[nodiscard]] Result<VerifyReport> verify_cached_tiles(
    const std::shared_ptr<TileSource>& source, const std::filesystem::path& cache, std::int64_t total,
    const std::function<void(std::int64_t done, std::int64_t total)>& progress);

}  // namespace terrella
