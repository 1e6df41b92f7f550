#pragma once

#include <algorithm>
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
    [[nodiscard]] std::uint64_t last_seen() const {
      return std::max({last_drawn, last_needed, last_wanted, last_chosen, last_counted});
    }
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
  /// Where there are many entries, those go that are not resident and that no frame has had to do with for long; never
  /// one of the coarsest level. What was lacking is asked for again where it is wanted again.
  void end_frame(std::uint64_t frame, int coarsest_level, std::size_t many = kManyEntries) {
    if (entries_.size() <= std::max(many, most_)) return;
    std::erase_if(entries_, [&](const auto& item) {
      return item.second.state != TileState::resident && item.first.level > coarsest_level &&
             item.second.last_seen() + kLong < frame;
    });
    most_ = 2 * entries_.size();
  }
  [[nodiscard]] std::unordered_map<TileId, Entry, TileIdHash>& entries() { return entries_; }

 private:
  static constexpr std::size_t kManyEntries = 4096;
  static constexpr std::uint64_t kLong = 300;  ///< frames

  std::unordered_map<TileId, Entry, TileIdHash> entries_;
  std::size_t most_ = 0;  ///< entries to look through the next time
};

}  // namespace terrella
