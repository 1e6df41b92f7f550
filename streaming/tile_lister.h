#pragma once

#include <functional>

#include "tiles/tile_source.h"

namespace terrella {

/// A source that can list its tiles: what is there is found without asking for each place of the grid, of which a
/// sparse set may have a million times more.
class TileLister {
 public:
  virtual ~TileLister() = default;
  /// Calls for each tile that is there and that exists() in the grid, squeezed ones too, level by level, until the call
  /// returns false. Needs the same memory for any number of tiles. The error names what cannot be listed. thread:
  /// worker
  [[nodiscard]] virtual Status for_each_tile(const std::function<bool(const TileId&)>& call) = 0;
};

}  // namespace terrella
