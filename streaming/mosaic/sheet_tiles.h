#pragma once

#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "streaming/mosaic/mosaic_index.h"
#include "streaming/mosaic/open_rasters.h"
#include "streaming/warp/warp_source.h"
#include "tiles/tile_source.h"

namespace terrella {

/// Tiles of each sheet, all in the mosaic's grid, made by warp. Sheets are opened when first needed, because PROJ takes
/// milliseconds for each. thread: any, several at once
class SheetTiles {
 public:
  /// `index` and `rasters` must outlive this object.
  SheetTiles(const MosaicIndex& index, OpenRasters& rasters, const TileGrid& grid, const Body& body);

  /// Makes a tile of the files of one or more sheets, given with the lowest sheet first. Colours of several sheets lie
  /// over each other; a number is the topmost one that is known.
  [[nodiscard]] Result<EncodedTile, TileFailure> make(const TileId& id, const std::vector<int>& sheets);
  /// The topmost known number at a place (TileSource::value_at()): of the pixel that the file itself has there.
  [[nodiscard]] Result<double, TileFailure> value_at(const Geodetic& place, const Ellipsoid& figure,
                                                     const std::vector<int>& sheets);

 private:
  struct OpenSheet {
    std::shared_ptr<TileSource> tiles;
    std::shared_ptr<TilePlanner> planner;
  };
  [[nodiscard]] Result<OpenSheet> open(int sheet);

  const MosaicIndex& index_;
  OpenRasters& rasters_;
  const TileGrid grid_;
  const Body body_;
  std::mutex mutex_;                           ///< guards the members below
  std::list<std::pair<int, OpenSheet>> open_;  ///< most recently used first
};

/// Decodes a tile that is local. thread: worker
[[nodiscard]] Result<Block, TileFailure> decode_tile(const EncodedTile& tile);

}  // namespace terrella
