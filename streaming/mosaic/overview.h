#pragma once

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <unordered_map>
#include <vector>

#include "streaming/mosaic/mosaic_store.h"
#include "streaming/warp/decoded_blocks.h"
#include "tiles/tile_source.h"

namespace terrella {

/// A tile as the overview sees it.
struct OverviewTile {
  bool is_empty = false;   ///< no file lies under it
  bool is_direct = false;  ///< made of files; otherwise of the four tiles under it
  std::uint64_t mark = 0;  ///< changes with the files under the tile
};

/// The coarse tiles of a mosaic, each made of the four under it, down to tiles that few files make. They are made once
/// and kept in the store. Two threads make them, so that a worker never waits for thousands of files.
class Overview : public RemoteTiles {
 public:
  struct Parts {
    int tile_px = 256;
    bool numbers = false;
    MosaicStore* store = nullptr;  ///< may be null
    std::function<void()> begin;   ///< called once, before tiles are made that the store does not have
    std::function<OverviewTile(const TileId&)> look;
    std::function<Result<EncodedTile, TileFailure>(const TileId&)> make_direct;
  };
  explicit Overview(Parts parts) : parts_(std::move(parts)) {}
  ~Overview() override;
  Overview(const Overview&) = delete;
  Overview& operator=(const Overview&) = delete;

  /// A tile that is kept; otherwise `remote`. thread: worker
  [[nodiscard]] Result<EncodedTile, TileFailure> read(const TileId& id, std::uint64_t mark);

  void fetch(const TileId& id, double priority, Done done) override;  ///< thread: any
  void set_priority(const TileId& id, double priority) override;      ///< thread: any
  void cancel(const TileId& id) override;                             ///< thread: any

 private:
  struct Wish {
    double priority = 0.0;
    Done done;
    bool in_work = false;
  };
  void work();
  [[nodiscard]] bool is_wanted(const TileId& wish);
  /// The pixels of a tile; `wish` is the tile for which they are made.
  [[nodiscard]] DecodedBlocks::Decoded pixels(const TileId& id, const TileId& wish);
  [[nodiscard]] Result<Block, TileFailure> make(const TileId& id, std::uint64_t mark, const TileId& wish);
  [[nodiscard]] EncodedTile encoded(std::shared_ptr<const Block> block) const;

  const Parts parts_;
  DecodedBlocks made_{8UL << 20};
  std::mutex mutex_;  ///< guards the members below
  std::condition_variable wake_;
  bool closing_ = false;
  bool begun_ = false;
  std::unordered_map<TileId, Wish, TileIdHash> wishes_;
  std::vector<std::thread> threads_;
};

}  // namespace terrella
