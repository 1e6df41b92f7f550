#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "base/result.h"
#include "tiles/tile_source.h"

namespace terrella {

/// Opens the files of several times beside a cache (file_of_time()) as one set, whose steps are those times. Sends no
/// request. It starts at the last one at or before `time`, else at the newest. nullptr if there are no such files.
/// thread: any
[[nodiscard]] Result<std::shared_ptr<TileSource>> open_dated_caches(const std::filesystem::path& cache,
                                                                    const std::string& time);

}  // namespace terrella
