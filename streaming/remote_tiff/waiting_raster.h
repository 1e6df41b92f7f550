#pragma once

#include <functional>
#include <memory>

#include "streaming/raster/raster_source.h"

namespace terrella {

/// Makes a raster whose read() waits for blocks that have to be fetched, and then fetches the blocks to the east of
/// them too: for a reader that goes through the whole picture by rows. Keeps a few hundred encoded blocks. `go_on` is
/// asked ten times a second; false ends the waiting. thread: any
[[nodiscard]] std::unique_ptr<RasterSource> waiting_raster(std::unique_ptr<RasterSource> raster,
                                                           std::function<bool()> go_on);

}  // namespace terrella
