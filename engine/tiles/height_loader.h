#pragma once

#include <memory>

#include "tiles/elevation_source.h"
#include "tiles/height_tile.h"
#include "tiles/tile_loader.h"

namespace terrella {

struct HeightLoaderOptions {
  int workers = 1;                              ///< threads that read and decode, [1, 64]
  std::size_t max_finished_bytes = 16UL << 20;  ///< decoded tiles that wait to be polled; over this, workers pause
  std::shared_ptr<ArrivalBell> bell = {};       ///< rung when a tile is finished; may be empty
};

extern template class Loader<HeightTile>;

/// Loads tiles of heights. thread: main
class HeightLoader : public Loader<HeightTile> {
 public:
  HeightLoader(const ElevationSource& source, const HeightLoaderOptions& options = {});
};
using LoadedHeights = Loaded<HeightTile>;

}  // namespace terrella
