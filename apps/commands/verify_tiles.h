#pragma once

#include <functional>
#include <memory>

#include "apps/commands/tile_set_report.h"

namespace terrella {

/// Called from time to time with tiles read so far and in all; false asks to stop.
using VerifyProgress = std::function<bool(std::int64_t done, std::int64_t total)>;

/// Reads and decodes every tile that is there, on several threads. The time and memory depend on the tiles, not on the
/// grid's places: a source that is no TileLister alone is asked for each place. Places without a tile are absent. An
/// error if the source cannot list its tiles, or if `progress` asked to stop. thread: main
[[nodiscard]] Result<VerifyReport> verify_tiles(const std::shared_ptr<TileSource>& source,
                                                const VerifyProgress& progress);

}  // namespace terrella
