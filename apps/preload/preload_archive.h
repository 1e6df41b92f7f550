#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "apps/preload/preload_source.h"
#include "base/result.h"
#include "streaming/cache/tile_cache.h"
#include "streaming/preload/tile_plan.h"

namespace terrella {

/// Cache that a preload fills: the output itself, or, for an MBTiles or PMTiles file, OUTPUT.unfinished.gpkg beside it.
/// Such a file is made of the cache when all its tiles are there. thread: any
[[nodiscard]] std::string cache_file_of(const std::string& output);

/// Fails if the output cannot hold the tiles of the source. thread: any
[[nodiscard]] Status check_archive(const std::string& output, const PreloadSource& source);

/// True if the output is an MBTiles or PMTiles file that an earlier preload has made of the same plan. Fails if
/// something else has the name of such an output. thread: any
[[nodiscard]] Result<bool> has_archive(const std::string& output, const PreloadSource& source, const TilePlan& plan);

/// Makes an MBTiles or PMTiles file of the planned tiles that a cache has, then removes the cache unless it has more
/// tiles, which the result says. Nothing but `cache` may have the cache open. `progress` returns false to stop. Blocks.
/// thread: any
[[nodiscard]] Result<bool> make_archive(const std::string& output, const PreloadSource& source, const TilePlan& plan,
                                        std::shared_ptr<TileCache> cache,
                                        const std::function<bool(std::int64_t done, std::int64_t total)>& progress);

}  // namespace terrella
