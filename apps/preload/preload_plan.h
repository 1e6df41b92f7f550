#pragma once

#include <memory>

#include "apps/preload/preload_options.h"
#include "base/result.h"
#include "streaming/preload/tile_plan.h"
#include "tiles/tile_source.h"

namespace terrella {

/// The tiles that a command line asks for: boxes and polygons together, or a flight; the shard of it. Reads the GeoJSON
/// files; the error names them. thread: main
[[nodiscard]] Result<std::shared_ptr<const TilePlan>> make_preload_plan(const PreloadCommand& command,
                                                                        const TileSetInfo& info);

}  // namespace terrella
