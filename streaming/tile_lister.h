#pragma once

#include <functional>

#include "tiles/tile_source.h"

namespace terrella {

/// A source that can list its tiles. Listing avoids a query for each place of the grid; a sparse set may have a million
/// times more places than tiles.
class TileLister {
 public:
  virtual ~TileLister() = default;
  /// Calls `call` for each existing tile of the grid, squeezed tiles included, level by level, until `call` returns
  /// false. Memory does not grow with the number of tiles. The error names the part that cannot be listed.
  /// thread: worker
  [[nodiscard]] virtual Status for_each_tile(const std::function<bool(const TileId&)>& call) = 0;
};

}  // namespace terrella
