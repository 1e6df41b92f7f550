#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <deque>
#include <optional>
#include <unordered_map>
#include <utility>

#include "tiles/tile_grid.h"

namespace terrella {

/// The life of a tile as the scene sees it, in order. Imagery and heights have the same life:
///   unknown -> resident   the tile was decoded and is in its place;
///   unknown -> missing    the tile failed; an ancestor is shown instead;
///   missing -> unknown    the tile failed for now, and it is time to retry (TileResidency::retry());
///   unknown -> outside    the grid or its bounds do not have the tile;
///   any     -> unknown    the tile was evicted or forgotten.
enum class TileState : std::uint8_t {
  unknown,   ///< never requested, or dropped since; a frame that wants it requests it
  resident,  ///< decoded and in its place: texels in a texture slot, heights in the height field
  missing,   ///< failed: an ancestor is shown, and nobody requests the tile until a retry
  outside,   ///< not in the grid or its bounds: an ancestor is shown, and nobody requests it
};

/// The states of all tiles of one kind, with the rules for retry, eviction and forgetting. Plain data: loaders fill it,
/// selection reads it. "Frame" is any number that grows from frame to frame. thread: main
class TileResidency {
 public:
  using Clock = std::chrono::steady_clock;
  struct Entry {
    TileState state = TileState::unknown;
    int slot = -1;                  ///< texture slot, if resident
    std::uint64_t last_drawn = 0;   ///< frame number, for eviction
    std::uint64_t last_needed = 0;  ///< frame number: drawn where nothing finer can still come, so not to be evicted
    std::uint64_t last_seen = 0;    ///< frame number: a frame took the tile into account
    std::uint64_t edition = 0;      ///< TileSource::edition() before the tile was read, if resident
    bool is_outdated = false;       ///< resident, and to be read again (Globe::invalidate())
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
  [[nodiscard]] const std::unordered_map<TileId, Entry, TileIdHash>& entries() const { return entries_; }
  [[nodiscard]] std::size_t count(TileState state) const {
    return static_cast<std::size_t>(
        std::ranges::count_if(entries_, [state](const auto& item) { return item.second.state == state; }));
  }

  /// Marks a failed tile as missing. `retry_at`: time of the next request; none: never. Times must come in ascending
  /// order.
  void set_missing(const TileId& id, std::optional<Clock::time_point> retry_at) {
    entries_[id].state = TileState::missing;
    if (retry_at) retries_.emplace_back(*retry_at, id);
  }
  [[nodiscard]] bool has_retry(Clock::time_point now) const {
    return !retries_.empty() && retries_.front().first <= now;
  }
  /// Makes missing tiles unknown again if their time to retry has come.
  void retry(Clock::time_point now) {
    for (; has_retry(now); retries_.pop_front()) {
      Entry* entry = find(retries_.front().second);
      if (entry != nullptr && entry->state == TileState::missing) entry->state = TileState::unknown;
    }
  }

  /// Returns the tile to evict: the resident tile drawn longest ago among those that the last frame did not need. None
  /// if every tile is in use. Tiles of the coarsest level are never evicted.
  [[nodiscard]] std::optional<TileId> to_evict(std::uint64_t frame, int coarsest_level) const {
    const std::pair<const TileId, Entry>* oldest = nullptr;
    for (const auto& item : entries_) {
      const Entry& entry = item.second;
      if (entry.state != TileState::resident || item.first.level == coarsest_level) continue;
      // Tiles that the last frame's view needs would be requested again at once.
      if (entry.last_drawn >= frame || entry.last_needed + 1 >= frame) continue;
      if (oldest == nullptr || entry.last_drawn < oldest->second.last_drawn) oldest = &item;
    }
    return oldest == nullptr ? std::nullopt : std::optional(oldest->first);
  }

  /// Forgets tiles once there are many: those that are not resident and that no frame has used for long, except the
  /// coarsest level. A missing tile that was forgotten is requested again if it is wanted again.
  void end_frame(std::uint64_t frame, int coarsest_level, std::size_t many = kManyEntries) {
    if (entries_.size() <= std::max(many, most_)) return;
    std::erase_if(entries_, [&](const auto& item) {
      return item.second.state != TileState::resident && item.first.level > coarsest_level &&
             item.second.last_seen + kLong < frame;
    });
    most_ = 2 * entries_.size();
  }

 private:
  static constexpr std::size_t kManyEntries = 4096;
  static constexpr std::uint64_t kLong = 300;  ///< frames

  std::unordered_map<TileId, Entry, TileIdHash> entries_;
  std::deque<std::pair<Clock::time_point, TileId>> retries_;  ///< the next one first
  std::size_t most_ = 0;                                      ///< entries to look through the next time
};

}  // namespace terrella
