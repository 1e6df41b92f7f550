#pragma once

#include <functional>
#include <map>
#include <memory>
#include <vector>

#include "base/result.h"
#include "streaming/preload/tile_origin.h"
#include "streaming/preload/tile_plan.h"
#include "streaming/remote_tiff/remote_tiff.h"
#include "streaming/warp/map/ground_map.h"

namespace terrella {

/// A span, and a block that is decoded from it.
struct PlannedSpan {
  ByteRange range;
  TileId block;
};
/// Spans of a file by their names in its cache.
using SpanList = std::map<TileId, PlannedSpan>;

/// Finds the bytes that the tiles of a plan are made of. `grid` is that of warp_grid(). The error names the file. Waits
/// for the network, which sends the table of tiles. `go_on` is asked after each tile. thread: any, one at a time
[[nodiscard]] Result<SpanList> spans_of_tiles(RemoteTiff& raster, const WarpFigure& figure, const TileGrid& grid,
                                              const TilePlan& tiles, const std::function<bool()>& go_on);

/// Spans of a file from the network, neighbours by one request, checked by `raster`. `spans` must contain each span
/// that is asked for. thread: any
[[nodiscard]] std::unique_ptr<TileOrigin> range_origin(const FileAddress& file, std::shared_ptr<RemoteTiff> raster,
                                                       const HttpOptions& options,
                                                       std::shared_ptr<const SpanList> spans, ReplyQueue& answers);

}  // namespace terrella
