#pragma once

#include <condition_variable>
#include <cstddef>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <unordered_map>
#include <unordered_set>

#include "streaming/warp/block.h"
#include "tiles/tile_source.h"

namespace terrella {

/// Cache of recently used decoded blocks, because neighbouring tiles use the same blocks. A block that two threads want
/// at once is decoded once. thread: any for every call
class DecodedBlocks {
 public:
  using Decoded = Result<std::shared_ptr<const Block>, TileFailure>;
  using Decode = std::function<Result<Block, TileFailure>()>;

  explicit DecodedBlocks(std::size_t max_bytes) : max_bytes_(max_bytes) {}

  /// Returns the block if it is cached, else null.
  [[nodiscard]] std::shared_ptr<const Block> find(const TileId& id);
  /// Returns the block. Decodes it if it is not cached and no other thread decodes it now. Failures are not cached.
  /// Exceptions of `decode` go to the caller.
  [[nodiscard]] Decoded get(const TileId& id, const Decode& decode);

 private:
  struct Held {
    TileId id;
    std::shared_ptr<const Block> block;
  };
  class Turn;

  /// Call with the lock held. Makes the block the most recently used.
  std::shared_ptr<const Block> held(const TileId& id);
  void hold(const TileId& id, std::shared_ptr<const Block> block);

  const std::size_t max_bytes_;
  std::mutex mutex_;  ///< guards the members below
  std::condition_variable done_;
  std::list<Held> blocks_;  ///< most recently used first
  std::unordered_map<TileId, std::list<Held>::iterator, TileIdHash> places_;
  std::unordered_set<TileId, TileIdHash> under_way_;
  std::size_t bytes_ = 0;
};

}  // namespace terrella
