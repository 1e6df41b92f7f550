#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <utility>
#include <vector>

#include "streaming/http/http_fetcher.h"

namespace terrella {

/// Passes answers from the threads that received them to the thread that processes them. Answers are handed over
/// several at a time, because waking a thread for each would cost as much as all other work for a small tile.
class AnswerQueue {
 public:
  void push(HttpReply&& reply) {
    const std::lock_guard lock(mutex_);
    replies_.push_back(std::move(reply));
    if (replies_.size() == kEnough) enough_.notify_one();
  }
  /// Returns the queued answers. Waits for several, but no longer than `longest`.
  [[nodiscard]] std::vector<HttpReply> take(std::chrono::milliseconds longest) {
    std::unique_lock lock(mutex_);
    enough_.wait_for(lock, longest, [this] { return replies_.size() >= kEnough; });
    return std::exchange(replies_, {});
  }

 private:
  static constexpr std::size_t kEnough = 32;
  std::mutex mutex_;
  std::condition_variable enough_;
  std::vector<HttpReply> replies_;
};

}  // namespace terrella
