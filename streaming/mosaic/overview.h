#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "base/result.h"
#include "streaming/mosaic/mosaic_store.h"
#include "streaming/warp/block.h"
#include "streaming/warp/stored_blocks.h"
#include "tiles/request_desk.h"

namespace terrella {

/// Pixels as bytes for the store, without loss: colours as PNG, numbers as floats packed by zlib. Empty if they cannot
/// be packed. thread: any
[[nodiscard]] std::vector<std::byte> pack_pixels(const Block& block);
/// Unpacks the pixels of a tile of `side_px`. thread: any
[[nodiscard]] Result<Block> unpack_pixels(std::span<const std::byte> bytes, int side_px, bool numbers);

/// A tile as the overview sees it.
struct OverviewTile {
  bool is_empty = false;   ///< no file lies under it
  bool is_direct = false;  ///< made of files; otherwise of the four tiles under it
  std::uint64_t mark = 0;  ///< changes with the files under the tile
};

/// The coarse tiles of a mosaic, each made of the four under it, down to tiles that few files make. They are made once
/// and kept in the store. Two threads make them, so that a worker never waits for thousands of files.
class Overview {
 public:
  struct Parts {
    int tile_px = 256;
    bool numbers = false;
    MosaicStore* store = nullptr;  ///< may be null
    std::function<void()> begin;   ///< called once, before tiles are made that the store does not have
    std::function<OverviewTile(const TileId&)> look;
    std::function<Result<EncodedTile, TileFailure>(const TileId&)> make_direct;
  };
  explicit Overview(Parts parts);

  /// A tile that is kept; otherwise `remote`. thread: worker
  [[nodiscard]] Result<EncodedTile, TileFailure> read(const TileId& id, std::uint64_t mark);

  [[nodiscard]] RemoteTiles& remote() { return desk_; }  ///< makes the others

 private:
  [[nodiscard]] Result<EncodedTile, TileFailure> work(const TileWish& wish);
  /// The pixels of a tile; `wish` is the wish for which they are made.
  [[nodiscard]] DecodedBlocks::Decoded pixels(const TileId& id, std::uint64_t wish);
  [[nodiscard]] Result<Block, TileFailure> make(const TileId& id, std::uint64_t mark, std::uint64_t wish);
  [[nodiscard]] EncodedTile encoded(std::shared_ptr<const Block> block) const;

  const Parts parts_;
  DecodedBlocks made_{8UL << 20};
  std::once_flag begun_;
  RequestDesk desk_;  ///< last: its threads use the others
};

}  // namespace terrella
