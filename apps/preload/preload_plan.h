#pragma once

#include <memory>

#include "apps/preload/preload_options.h"
#include "base/result.h"
#include "streaming/preload/tile_plan.h"
#include "tiles/tile_source.h"

namespace terrella {

/// Lists the tiles of a command line: boxes and polygons together, or a flight, reduced to the requested shard. Reads
/// the GeoJSON files; an error names the file. thread: main
[[nodiscard]] Result<std::shared_ptr<const TilePlan>> make_preload_plan(const PreloadCommand& command,
                                                                        const TileSetInfo& info);

}  // namespace terrella
