#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <unordered_map>
#include <vector>

#include "streaming/warp/warp_job.h"
#include "tiles/request_desk.h"

namespace terrella {

/// Fetches the blocks of many tiles at once: each block once, however many tiles wait for it. No block is looked up
/// under a lock, because the disk may be slow and `main` takes the lock.
class BlockFetcher : public std::enable_shared_from_this<BlockFetcher> {
 public:
  using Encoded = Result<EncodedTile, TileFailure>;
  using MakeJob = std::function<Result<WarpJob, TileFailure>(const TileId&)>;

  /// Keeps `blocks`, whose network it asks.
  BlockFetcher(std::shared_ptr<const StoredBlocks> blocks, MakeJob make_job, bool numbers);

  [[nodiscard]] RemoteTiles& tiles() { return desk_; }
  /// Ends as RequestDesk::close() does.
  void close() { desk_.close(); }

 private:
  struct Answer {
    TileId stored;
    FoundBlock found;
  };
  struct Tile {
    std::optional<WarpJob> job;  ///< belongs to the thread that works on the wish, without the lock
    double priority = 0.0;
    std::vector<Answer> answers{};  ///< answers that came and were not worked on yet
    std::vector<TileId> missing{};  ///< the blocks that it waits for
  };

  // thread: the desk's
  [[nodiscard]] std::optional<Encoded> work(const TileWish& wish);
  [[nodiscard]] Tile& tile_of(const TileWish& wish);
  [[nodiscard]] std::uint64_t settle(Tile& tile);
  void wait_for(const TileWish& wish, Tile& tile, const std::vector<TileId>& missing, std::uint64_t arrivals);
  void ask(const TileId& stored, double priority, bool may_have_come);

  // thread: any
  void move(const TileWish& wish);
  void stop_waiting(std::uint64_t wish);
  void arrive(const TileId& stored, Encoded&& answer);
  [[nodiscard]] double priority_of(const TileId& stored) const;  ///< call with the lock held

  const std::shared_ptr<const StoredBlocks> blocks_;
  RemoteTiles& network_;
  const MakeJob make_job_;
  const bool numbers_;
  std::mutex mutex_;                                                            ///< guards the members below
  std::uint64_t arrivals_ = 0;                                                  ///< counts the answers of the network
  std::unordered_map<std::uint64_t, Tile> tiles_;                               ///< by the wish's number
  std::unordered_map<TileId, std::vector<std::uint64_t>, TileIdHash> waiting_;  ///< wishes that wait for a stored block
  RequestDesk desk_;                                                            ///< last: its threads use the others
};

}  // namespace terrella
