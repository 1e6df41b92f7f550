#pragma once

#include <memory>

#include "apps/open_scene/options/source_options.h"
#include "base/result.h"
#include "tiles/tile_source.h"

namespace terrella {

/// Opens a remote TILESET with its cache: --cache, else a file in the user's cache folder; "off" disables the cache.
/// With --offline only the cache is opened and no request is sent. Reports a damaged cache that was set aside. Reports
/// once that a cache is not writable, then continues without one. The error names TILESET or the cache. thread: main
[[nodiscard]] Result<std::shared_ptr<TileSource>> open_remote(const SourceOptions& options);

}  // namespace terrella
