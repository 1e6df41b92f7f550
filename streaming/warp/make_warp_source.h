#pragma once

#include <memory>
#include <string>

#include "streaming/warp/stored_blocks.h"
#include "streaming/warp/warp_plan.h"
#include "streaming/warp/warp_source.h"

namespace terrella {

/// Plans tiles for several threads at a time: each uses its own map, because PROJ's objects belong to one thread.
/// thread: any
class TilePlanner {
 public:
  /// Fails as GroundMap::open() does.
  [[nodiscard]] static Result<std::shared_ptr<TilePlanner>> open(const RasterInfo& raster, const WarpFigure& figure,
                                                                 const TileGrid& grid, Overviews overviews,
                                                                 Detail detail = Detail::usual);
  [[nodiscard]] const WarpFrame& frame() const { return frame_; }
  /// Fails if no map can be opened for a further thread: too many open files, not enough memory.
  [[nodiscard]] Result<WarpPlan, TileFailure> plan(const TileId& id);
  /// The pixel of the raster's finest level under a place; infinite if there is none (GroundMap::pixels()). Fails as
  /// plan() does.
  [[nodiscard]] Result<CrsPoint, TileFailure> pixel_at(const RowPlace& place);

 private:
  /// Lends a map of its own to a caller.
  [[nodiscard]] Result<GroundMap, TileFailure> take_map();
  void put_back(GroundMap map);
  TilePlanner(const RasterInfo& raster, const WarpFigure& figure, GroundMap map, const TileGrid& grid,
              Overviews overviews, Detail detail);

  const RasterInfo raster_;
  const WarpFigure figure_;
  const WarpFrame frame_;
  std::mutex mutex_;             ///< guards idle_
  std::vector<GroundMap> idle_;  ///< maps that no thread uses
};

/// Makes a source of tiles in a given grid; `info` describes it.
[[nodiscard]] std::unique_ptr<TileSource> make_warp_source(std::unique_ptr<RasterSource> raster,
                                                           std::shared_ptr<TilePlanner> planner, TileSetInfo info,
                                                           BlockNames names, std::size_t decoded_bytes);

}  // namespace terrella
