#pragma once

#include <functional>
#include <memory>

#include "apps/tile_set_report.h"

namespace terrella {

/// Reads and decodes every tile within the bounds, on several threads. `progress` is called from time to time with
/// tiles asked for so far and in all. thread: main
[[nodiscard]] VerifyReport verify_tiles(const std::shared_ptr<TileSource>& source,
                                        const std::function<void(std::int64_t done, std::int64_t total)>& progress);

}  // namespace terrella
