#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "apps/open_scene/options/source_options.h"
#include "base/result.h"
#include "tiles/tile_source.h"

namespace terrella {

/// Opens a remote TILESET with its cache: --cache, else a file in the user's cache folder; "off" disables the cache.
/// With --offline only the cache is opened and no request is sent. Reports a damaged cache that was set aside. Reports
/// once that a cache is not writable, then continues without one. The error names TILESET or the cache. thread: main
[[nodiscard]] Result<std::shared_ptr<TileSource>> open_remote(const SourceOptions& options);

/// The file in which the viewer caches a remote TILESET at a time. `opened`: the set as it was opened. thread: any
[[nodiscard]] Result<std::filesystem::path> cache_file_of_set(SourceOptions options, const TileSetInfo& opened,
                                                              const std::string& time);

}  // namespace terrella
