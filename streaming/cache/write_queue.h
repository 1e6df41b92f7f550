#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <unordered_map>
#include <utility>
#include <vector>

#include "streaming/cache/tile_cache.h"

namespace terrella {

struct Renewal {
  std::int64_t stored_unix_s = 0;
  std::optional<std::int64_t> expires_unix_s;
};

/// Tiles of one column, from the change's tile down to row `last_y`, to pin or release.
struct PinRun {
  std::int64_t last_y = 0;
  bool pinned = true;
};

/// A queued change: a record, a run to pin, or, if both are empty, the renewal of a record.
struct CacheChange {
  TileId id;
  std::shared_ptr<const CacheRecord> record;
  Renewal renewal;
  std::function<void(const StoreStatus&)> on_durable;
  std::optional<PinRun> pin = {};
};

/// Queued changes of one place that the file does not contain yet.
struct PendingRecord {
  std::shared_ptr<const CacheRecord> record;  ///< none: the file's record holds
  std::optional<Renewal> renewal;             ///< applies to `record`, or to the record in the file
  std::uint64_t last_change = 0;
};

struct CacheBatch {
  std::vector<CacheChange> changes;
  std::vector<std::pair<std::int64_t, std::int64_t>> uses;  ///< row id of a tile, time of its last use
  std::uint64_t last_change = 0;
  bool last = false;  ///< the queue is closed and this batch is its remainder
};

/// Ordered queue of changes for the writer. Shows readers the effect of changes before they are written.
class WriteQueue {
 public:
  struct Limits {
    std::size_t batch_tiles = 256;
    std::size_t batch_bytes = 8UL << 20;
    std::size_t queued_bytes = 64UL << 20;
  };
  explicit WriteQueue(const Limits& limits) : limits_(limits) {}

  /// Queues a change. Blocks while too many bytes are queued, unless the caller is the writer. thread: any
  void push(CacheChange change);
  /// thread: any
  void note_use(std::int64_t row, std::int64_t used_unix_s);
  [[nodiscard]] std::optional<PendingRecord> pending(const TileId& id) const;  ///< thread: any
  /// True if pending() has a record for any of these rows of a column. thread: any
  [[nodiscard]] bool has_pending_in(int level, std::int64_t x, std::int64_t first_y, std::int64_t last_y) const;

  /// Blocks until there are changes, then waits a moment for more. Also returns at `until`, perhaps with an empty
  /// batch. thread: the writer
  [[nodiscard]] CacheBatch take(std::chrono::steady_clock::time_point until);
  /// Reports that the batch was written, or never will be. thread: the writer
  void finish(const CacheBatch& batch, const Status& status);

  /// Blocks until all changes pushed so far are finished. Returns the first error since the last call.
  /// thread: any but the writer
  [[nodiscard]] Status flush();
  void close();  ///< ends the waits of take(). thread: any

 private:
  void merge_pending(const CacheChange& change);
  [[nodiscard]] bool hurried() const;
  [[nodiscard]] CacheBatch take_locked();

  const Limits limits_;
  mutable std::mutex mutex_;
  std::condition_variable work_, space_, done_;
  std::deque<CacheChange> changes_;  ///< mutex_ guards this and all members below
  std::unordered_map<TileId, PendingRecord, TileIdHash> pending_;
  std::unordered_map<std::int64_t, std::int64_t> uses_;
  std::chrono::steady_clock::time_point first_use_noted_{};
  std::size_t queued_bytes_ = 0;   ///< bytes in changes_ and in the batch that is being written
  std::uint64_t pushed_ = 0;       ///< number of the last pushed change
  std::uint64_t finished_ = 0;     ///< number of the last finished change
  std::uint64_t flush_up_to_ = 0;  ///< a flush() waits for this change
  std::optional<Error> first_error_;
  std::thread::id writer_;
  bool closed_ = false;
};

}  // namespace terrella
