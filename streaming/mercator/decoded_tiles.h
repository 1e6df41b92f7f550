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

/// The pictures of the tiles used last, since neighbouring tiles are made of the same ones. What two threads want at
/// once is decoded once. thread: any for every call
class DecodedTiles {
 public:
  using Decoded = Result<std::shared_ptr<const Image>, TileFailure>;
  using Decode = std::function<Result<Image, TileFailure>()>;

  explicit DecodedTiles(std::size_t max_bytes) : max_bytes_(max_bytes) {}

  /// The picture if it is held; else nothing.
  [[nodiscard]] std::shared_ptr<const Image> find(const TileId& id);
  /// The picture, decoded by this call if it is not held and nobody decodes it now. Failures are not held. What
  /// `decode` throws goes on to the caller.
  [[nodiscard]] Decoded get(const TileId& id, const Decode& decode);

 private:
  struct Held {
    TileId id;
    std::shared_ptr<const Image> picture;
  };
  class Turn;

  std::shared_ptr<const Image> held(const TileId& id);  ///< with the lock; the tile is then the latest used
  void hold(const TileId& id, std::shared_ptr<const Image> picture);

  const std::size_t max_bytes_;
  std::mutex mutex_;  ///< guards what follows
  std::condition_variable done_;
  std::list<Held> tiles_;  ///< the latest used first
  std::unordered_map<TileId, std::list<Held>::iterator, TileIdHash> places_;
  std::unordered_set<TileId, TileIdHash> under_way_;
  std::size_t bytes_ = 0;
};

}  // namespace terrella
