#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "geo/tile_grid.h"

namespace terrella {

/// The life of a tile as the scene sees it, in order.
enum class TileState : std::uint8_t {
  unknown,   ///< never asked for, or dropped since
  resident,  ///< its texels are in a texture slot and can be drawn
  lacking,   ///< it finally failed: an ancestor stands in for good
  outside,   ///< the grid or its bounds do not have it: an ancestor stands in, and nobody asks
};

/// Which tiles can be drawn, and from which slot. Plain data: the renderer fills it, selection reads it.
/// thread: main
class TileResidency {
 public:
  struct Entry {
    TileState state = TileState::unknown;
    int slot = -1;                   ///< if resident
    std::uint64_t last_drawn = 0;    ///< frame number, for eviction
    std::uint64_t last_needed = 0;   ///< frame number: drawn where nothing finer can still come, so not to be evicted
    std::uint64_t last_wanted = 0;   ///< frame number, so that a frame lists a tile once
    std::uint64_t last_chosen = 0;   ///< frame number: what a cell would take by itself
    std::uint64_t last_counted = 0;  ///< frame number, so that a frame counts a tile once
  };

  [[nodiscard]] Entry& entry(const TileId& id) { return entries_[id]; }
  [[nodiscard]] Entry* find(const TileId& id) {
    const auto it = entries_.find(id);
    return it == entries_.end() ? nullptr : &it->second;
  }
  [[nodiscard]] const Entry* find(const TileId& id) const {
    const auto it = entries_.find(id);
    return it == entries_.end() ? nullptr : &it->second;
  }
  void erase(const TileId& id) { entries_.erase(id); }
  [[nodiscard]] std::unordered_map<TileId, Entry, TileIdHash>& entries() { return entries_; }

 private:
  std::unordered_map<TileId, Entry, TileIdHash> entries_;
};

}  // namespace terrella
