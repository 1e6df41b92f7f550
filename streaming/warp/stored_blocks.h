#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "streaming/raster/raster_source.h"
#include "streaming/warp/decoded_blocks.h"
#include "streaming/warp/warp_levels.h"

namespace terrella {

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
