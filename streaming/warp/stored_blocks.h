#pragma once

#include <condition_variable>
#include <cstddef>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "streaming/raster/raster_source.h"
#include "streaming/warp/block.h"
#include "streaming/warp/warp_levels.h"
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

/// State of a block: it is encoded, decoded, or missing for a reason.
struct FoundBlock {
  std::shared_ptr<const EncodedTile> encoded;
  std::shared_ptr<const Block> decoded;
  std::optional<TileFailure> failure;

  [[nodiscard]] static FoundBlock of(Result<EncodedTile, TileFailure>&& answer);
};

/// Words for a block in messages: "made of the Web Mercator tile 5/10/13: …".
struct BlockNames {
  std::string noun = "raster's block";
  int first_level = 0;  ///< name of level 0
};

/// Reads and decodes the blocks of a raster. Blocks are named by the index in `levels`, columns and rows. thread: any
class StoredBlocks {
 public:
  StoredBlocks(std::shared_ptr<RasterSource> raster, std::vector<WarpLevel> levels, BlockNames names,
               std::size_t decoded_bytes);

  [[nodiscard]] const std::vector<WarpLevel>& levels() const { return levels_; }
  [[nodiscard]] const WarpLevel& level(int index) const { return levels_[static_cast<std::size_t>(index)]; }
  [[nodiscard]] RemoteTiles* network() const { return raster_->remote(); }
  /// The block as the raster names it.
  [[nodiscard]] TileId stored(const TileId& block) const;
  /// Reads a block, as the raster names it, without a request.
  [[nodiscard]] Result<EncodedTile, TileFailure> read(const TileId& stored) const { return raster_->read(stored); }
  /// Looks a block up without a request.
  [[nodiscard]] FoundBlock find(const TileId& block) const;
  /// Decodes a block, unless it is decoded already. Broken if it has another size than its level says.
  [[nodiscard]] DecodedBlocks::Decoded decode(const TileId& block, const FoundBlock& found) const;
  /// RasterSource::value_at() of the pixel of the finest level around a point.
  [[nodiscard]] Result<double, TileFailure> value_at(const CrsPoint& pixel) const;
  /// Puts the block's name before a reason.
  [[nodiscard]] std::string named(const TileId& block, const std::string& why) const;

 private:
  [[nodiscard]] Result<Block, TileFailure> decode_whole(const TileId& block, const EncodedTile& encoded) const;

  const std::shared_ptr<RasterSource> raster_;
  const std::vector<WarpLevel> levels_;
  const BlockNames names_;
  const std::unique_ptr<DecodedBlocks> decoded_;
};

}  // namespace terrella
