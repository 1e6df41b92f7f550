#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "streaming/cache/tile_cache.h"
#include "tiles/tile_grid.h"

namespace terrella {

/// Counts the records that a preload has sent to the cache's writer, and their results. thread: any
class StoreTally : public std::enable_shared_from_this<StoreTally> {
 public:
  enum class Kind : std::size_t { tile, unchanged, absent, blank, kept };
  using OnDurable = std::function<void(const StoreStatus&)>;

  /// `on_stored` is called on the writer's thread for each durable tile. It may be empty.
  explicit StoreTally(std::function<void(const TileId&)> on_stored) : on_stored_(std::move(on_stored)) {}

  /// Counts a record as sent. Returns the function to pass to TileCache as `on_durable`.
  [[nodiscard]] OnDurable sent(Kind kind, const TileId& id, std::size_t bytes);

  [[nodiscard]] std::int64_t durable(Kind kind) const { return durable_[static_cast<std::size_t>(kind)]; }
  [[nodiscard]] std::uint64_t bytes() const { return bytes_; }
  [[nodiscard]] bool failed() const { return failed_; }
  [[nodiscard]] Error error() const;  ///< the first error; call only if failed()
  /// Returns the tiles that found no room in the cache since the last call.
  [[nodiscard]] std::vector<TileId> take_without_room();
  [[nodiscard]] bool out_of_room() const { return out_of_room_; }  ///< some tile found no room
  [[nodiscard]] bool settled() const { return open_ == 0; }        ///< nothing is in flight

 private:
  void ended(Kind kind, const TileId& id, std::size_t bytes, const StoreStatus& status);

  std::function<void(const TileId&)> on_stored_;
  std::atomic<std::int64_t> durable_[5] = {};
  std::atomic<std::uint64_t> bytes_ = 0;
  std::atomic<std::int64_t> open_ = 0;
  std::atomic<bool> failed_ = false;
  std::atomic<bool> out_of_room_ = false;
  mutable std::mutex mutex_;
  std::optional<Error> error_;        ///< guarded by mutex_
  std::vector<TileId> without_room_;  ///< guarded by mutex_
};

}  // namespace terrella
