#pragma once

#include <condition_variable>
#include <cstddef>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <unordered_map>
#include <unordered_set>

#include "codecs/image.h"
#include "tiles/tile_source.h"

namespace terrella {

/// Cache of recently used decoded tiles, because neighbouring tiles use the same sources. A tile that two threads want
/// at once is decoded once. thread: any for every call
class DecodedTiles {
 public:
  using Decoded = Result<std::shared_ptr<const Image>, TileFailure>;
  using Decode = std::function<Result<Image, TileFailure>()>;

  explicit DecodedTiles(std::size_t max_bytes) : max_bytes_(max_bytes) {}

  /// Returns the picture if it is cached, else null.
  [[nodiscard]] std::shared_ptr<const Image> find(const TileId& id);
  /// Returns the picture. Decodes it if it is not cached and no other thread decodes it now. Failures are not cached.
  /// Exceptions of `decode` go to the caller.
  [[nodiscard]] Decoded get(const TileId& id, const Decode& decode);

 private:
  struct Held {
    TileId id;
    std::shared_ptr<const Image> picture;
  };
  class Turn;

  /// Call with the lock held. Makes the tile the most recently used.
  std::shared_ptr<const Image> held(const TileId& id);
  void hold(const TileId& id, std::shared_ptr<const Image> picture);

  const std::size_t max_bytes_;
  std::mutex mutex_;  ///< guards the members below
  std::condition_variable done_;
  std::list<Held> tiles_;  ///< most recently used first
  std::unordered_map<TileId, std::list<Held>::iterator, TileIdHash> places_;
  std::unordered_set<TileId, TileIdHash> under_way_;
  std::size_t bytes_ = 0;
};

}  // namespace terrella
