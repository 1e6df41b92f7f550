#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <unordered_map>
#include <vector>

#include "tiles/tile_source.h"

namespace terrella {

/// A user's wish for a tile.
struct TileWish {
  std::uint64_t number = 0;  ///< from 1; each wish of a desk has its own
  TileId id;
  double priority = 0.0;  ///< larger first
  bool is_new = true;     ///< nobody has worked on the wish yet
};

/// The wishes for a source's tiles, and the threads that work on them, the most wanted wish first. The desk itself
/// calls `done`, after the work has returned. So an answer may release the last owner of the source and of its desk
/// (engine/DESIGN.md, 26). An answer must not throw.
class RequestDesk : public RemoteTiles {
 public:
  using Answer = Result<EncodedTile, TileFailure>;
  /// Works on a wish. Without an answer the wish waits for resume(). An exception becomes a failed tile. thread: one of
  /// the desk's, one at a time for each wish
  using Work = std::function<std::optional<Answer>(const TileWish&)>;
  struct Parts {
    Work work;  ///< on a new wish, and on one that is resumed without other work
    // Called with the desk's lock held, so these two must not call the desk. thread: any
    std::function<void(const TileWish&)> moved = {};  ///< the priority has changed
    /// The wish is answered, or given up; comes once for each wish, after the last work on it.
    std::function<void(const TileWish&, bool is_answered)> ended = {};
    int threads = 2;    ///< started at the first wish
    int beginners = 2;  ///< most threads that work on new wishes at once
  };

  explicit RequestDesk(Parts parts) : parts_(std::move(parts)) {}
  ~RequestDesk() override { close(); }
  RequestDesk(const RequestDesk&) = delete;
  RequestDesk& operator=(const RequestDesk&) = delete;

  /// Replaces an earlier wish for the same tile. Throws if the system has no thread left. thread: any
  void fetch(const TileId& id, double priority, Done done) override;
  void set_priority(const TileId& id, double priority) override;  ///< thread: any
  void cancel(const TileId& id) override;                         ///< thread: any

  /// Goes on with a wish, if it is still wanted: with `next`, or with Parts::work again. thread: any
  void resume(std::uint64_t number, Work next = {});
  void resume(const TileId& id);                             ///< thread: any
  void resume_all();                                         ///< thread: any
  [[nodiscard]] bool is_wanted(std::uint64_t number) const;  ///< thread: any

  /// Gives up all wishes and ends the threads. Waits for work in progress, but not for an answer that makes this call.
  /// What the work uses must live until then. thread: any, one at a time, but not from the work
  void close();

 private:
  struct Entry {
    TileWish wish;
    Done done;
    std::vector<Work> next{};  ///< empty: the wish waits. An empty Work is Parts::work
    bool in_work = false;
  };
  struct Task {
    TileWish wish;
    std::vector<Work> works;
  };
  using Entries = std::map<TileId, Entry>;
  struct Thread {
    std::future<void> ended;
    std::thread::id id;
  };

  // Call the functions below with the lock held.
  void start_threads();
  void resume(Entry& entry, Work next = {});
  [[nodiscard]] Entries::iterator most_wanted();
  Done remove(Entries::iterator entry, bool is_answered);

  // thread: the desk's
  void run(std::size_t thread);
  [[nodiscard]] std::optional<Task> next();
  [[nodiscard]] std::optional<Answer> worked(const Task& task) const;
  [[nodiscard]] Done put_back(const TileWish& wish, bool is_answered);

  const Parts parts_;
  mutable std::mutex mutex_;  ///< guards the members below
  std::condition_variable ready_;
  const std::shared_ptr<std::atomic<bool>> closed_ = std::make_shared<std::atomic<bool>>(false);  ///< outlives the desk
  Entries wishes_;
  std::unordered_map<std::uint64_t, TileId> ids_;  ///< by number
  std::uint64_t last_number_ = 0;
  int beginning_ = 0;  ///< threads that work on new wishes
  std::vector<Thread> threads_;
};

}  // namespace terrella
