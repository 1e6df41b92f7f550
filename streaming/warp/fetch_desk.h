#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <unordered_map>
#include <vector>

#include "streaming/warp/warp_job.h"

namespace terrella {

/// Fetches the blocks of many tiles at once: each block once, however many tiles wait for it. No block is looked up
/// under the desk's lock, because the disk may be slow and `main` takes the lock.
class FetchDesk : public std::enable_shared_from_this<FetchDesk> {
 public:
  using Encoded = Result<EncodedTile, TileFailure>;

  FetchDesk(RemoteTiles& network, std::shared_ptr<const StoredBlocks> blocks, bool numbers)
      : network_(network), blocks_(std::move(blocks)), numbers_(numbers) {}

  void fetch(const TileId& id, WarpJob job, double priority, RemoteTiles::Done done);  ///< thread: worker
  void set_priority(const TileId& id, double priority);                                ///< thread: any
  void cancel(const TileId& id);                                                       ///< thread: any
  /// Waits for the look-ups that run. Nothing is called back any more. thread: any
  void close();

 private:
  struct Answer {
    TileId stored;
    FoundBlock found;
  };
  struct Wish {
    Wish(WarpJob its_job, double its_priority, RemoteTiles::Done its_done)
        : job(std::move(its_job)), priority(its_priority), done(std::move(its_done)) {}
    WarpJob job;  ///< belongs to the thread that works on the wish, without the lock
    double priority;
    RemoteTiles::Done done;
    bool in_work = false;
    std::vector<Answer> answers;  ///< answers that came and were not worked on yet
    std::vector<TileId> missing;  ///< the blocks that it waits for
  };
  using Lock = std::unique_lock<std::mutex>;

  // Call the functions below with the lock held.
  void work_on(Lock& lock, const TileId& id, const std::shared_ptr<Wish>& wish);
  [[nodiscard]] bool is_wanted(const TileId& id, const std::shared_ptr<Wish>& wish) const;
  std::vector<TileId> look(Lock& lock, Wish& wish);
  [[nodiscard]] double priority_of(const TileId& stored) const;
  void wait_for(Lock& lock, const TileId& id, Wish& wish, const std::vector<TileId>& missing);
  void stop_waiting(const TileId& id, const std::vector<TileId>& missing);

  void arrive(const TileId& stored, Encoded&& answer);  ///< thread: a thread of the raster

  RemoteTiles& network_;
  const std::shared_ptr<const StoredBlocks> blocks_;
  const bool numbers_;
  std::mutex mutex_;  ///< guards the members below
  std::condition_variable idle_;
  bool closed_ = false;
  int working_ = 0;             ///< threads in work_on()
  std::uint64_t arrivals_ = 0;  ///< counts the answers of the network
  std::unordered_map<TileId, std::shared_ptr<Wish>, TileIdHash> wishes_;
  std::unordered_map<TileId, std::vector<TileId>, TileIdHash> waiting_;  ///< tiles that wait for each stored block
};

}  // namespace terrella
