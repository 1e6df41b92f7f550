#pragma once

#include <algorithm>
#include <cassert>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <future>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <stop_token>
#include <system_error>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "tiles/arrival_bell.h"
#include "tiles/late_workers.h"
#include "tiles/tile_loader.h"
#include "tiles/tile_source.h"

namespace terrella {

/// Implementation of Loader. `Decoded` has a size_bytes(). Made by start_scheduler() as a shared object, because an
/// answer of the network may arrive, and a worker may end, after the owner is gone.
template <class Decoded>
class TileScheduler : public std::enable_shared_from_this<TileScheduler<Decoded>> {
 public:
  using Decode = std::function<Result<Decoded, TileFailure>(const TileId& id, const EncodedTile& tile)>;
  using Finished = Loaded<Decoded>;

  /// `decode` runs in several workers at once. If it throws, the tile fails.
  TileScheduler(std::shared_ptr<TileSource> source, Decode decode, std::size_t max_finished_bytes,
                std::shared_ptr<ArrivalBell> bell)
      : source_(std::move(source)),
        decode_(std::move(decode)),
        max_finished_bytes_(max_finished_bytes),
        bell_(std::move(bell)) {}

  // thread: main
  void start(int workers) {
    const std::lock_guard lock(mutex_);
    for (int i = 0; i < workers; ++i) {
      try {
        workers_.push_back({.ended = std::async(std::launch::async, [self = this->shared_from_this(), i]() mutable {
                              self->work(static_cast<std::size_t>(i));
                              self.reset();  // not later, when the future goes
                            })});
      } catch (const std::system_error&) {
        if (workers_.empty()) throw;
        return;  // the system has no more threads; work with fewer
      }
    }
  }
  /// Drops waiting tiles and ends the workers. A worker that reads or decodes ends after that, with the source that it
  /// keeps (late_workers.h).
  void stop();
  void request(std::span<const TileRequest> wanted);
  void reread(const TileId& id);
  [[nodiscard]] std::vector<Finished> poll(std::size_t max_bytes);
  bool wait(std::chrono::steady_clock::time_point deadline);
  [[nodiscard]] LoaderCounts counts() const;

 private:
  using TileIdSet = std::unordered_set<TileId, TileIdHash>;
  using Wishes = std::unordered_map<TileId, double, TileIdHash>;
  using Encoded = Result<EncodedTile, TileFailure>;
  struct Arrived {
    TileId id;
    Encoded encoded;
    std::uint64_t edition = 0;
  };

  // thread: main
  [[nodiscard]] static Wishes best_wishes(std::span<const TileRequest> wanted);
  [[nodiscard]] bool under_way(const TileId& id) const;
  /// Bytes that a finished tile counts against the bound. A failure counts a little, so that failures are bounded too.
  [[nodiscard]] static std::size_t weight_bytes(const Finished& finished) {
    constexpr std::size_t kFailureBytes = 1024;
    return finished.tile ? size_bytes(*finished.tile) : kFailureBytes;
  }

  // thread: worker
  void work(std::size_t worker);
  void look_for(std::unique_lock<std::mutex>& lock, const TileRequest& wish);
  [[nodiscard]] Encoded read(const TileId& id);
  void decode(std::unique_lock<std::mutex>& lock, const Arrived& tile);
  [[nodiscard]] Result<Decoded, TileFailure> decoded(const Arrived& tile) const;
  [[nodiscard]] bool may_start() const {
    return !(waiting_.empty() && arrived_.empty()) && finished_bytes_ < max_finished_bytes_;
  }

  // thread: a thread of the source
  void arrive(Arrived tile);

  const std::shared_ptr<TileSource> source_;
  const Decode decode_;
  RemoteTiles* const remote_ = source_->remote();
  const std::size_t max_finished_bytes_;
  const std::shared_ptr<ArrivalBell> bell_;  ///< may be empty

  struct Worker {
    std::future<void> ended = {};
    bool is_busy = false;  ///< reads or decodes
  };

  std::stop_source stop_;     ///< for reads
  mutable std::mutex mutex_;  ///< guards all members below
  std::condition_variable work_changed_;
  std::condition_variable finished_changed_;
  bool stopping_ = false;
  std::vector<TileRequest> waiting_;  ///< ascending priority: the next tile is the last element
  TileIdSet running_;
  TileIdSet outdated_;  ///< those among running_ that are read again
  TileIdSet fetching_;
  std::deque<Arrived> arrived_;
  TileIdSet finished_ids_;
  std::deque<Finished> finished_;
  std::size_t finished_bytes_ = 0;
  std::size_t read_ = 0;
  std::size_t missing_ = 0;

  std::vector<Worker> workers_;
};

}  // namespace terrella

#include "tiles/tile_scheduler.inl"
