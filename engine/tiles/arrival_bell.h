#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>

namespace terrella {

/// Wakes one waiting thread when any of several loaders finishes a tile.
class ArrivalBell {
 public:
  void ring() {  ///< thread: any
    {
      const std::lock_guard lock(mutex_);
      rung_ = true;
    }
    rang_.notify_one();
  }
  /// Waits for a ring since the last wait, or until the deadline. thread: any, but one waiter at a time
  void wait_until(std::chrono::steady_clock::time_point deadline) {
    std::unique_lock lock(mutex_);
    rang_.wait_until(lock, deadline, [this] { return rung_; });
    rung_ = false;
  }

 private:
  std::mutex mutex_;
  std::condition_variable rang_;
  bool rung_ = false;  ///< guarded by mutex_
};

}  // namespace terrella
