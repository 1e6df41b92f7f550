#pragma once

#include <functional>
#include <memory>

#include "apps/commands/tile_set_report.h"

namespace terrella {

/// Receives the tiles read so far and the total from time to time; false requests a stop.
using VerifyProgress = std::function<bool(std::int64_t done, std::int64_t total)>;

/// Reads and decodes every stored tile on several threads. Time and memory depend on the number of tiles, not on the
/// grid's places; only a source that is no TileLister is tried at each place. Places without a tile count as missing.
/// Fails if the source cannot list its tiles, or if `progress` requests a stop. thread: main
[[nodiscard]] Result<VerifyReport> verify_tiles(const std::shared_ptr<TileSource>& source,
                                                const VerifyProgress& progress);

}  // namespace terrella
