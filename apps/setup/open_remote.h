#pragma once

#include <memory>

#include "apps/setup/scene_options.h"
#include "base/result.h"
#include "tiles/tile_source.h"

namespace terrella {

/// Opens a remote TILESET with its cache (--cache, else one of its own in the user's cache folder; "off": none). With
/// --offline the cache alone is opened, and nothing is asked of anybody. Says on standard error when a damaged cache
/// was set aside, and once when a cache cannot be written: then it goes on without. The error names TILESET or the
/// cache. thread: main
[[nodiscard]] Result<std::shared_ptr<TileSource>> open_remote(const SceneOptions& options);

}  // namespace terrella
