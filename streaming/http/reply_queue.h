#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "streaming/http/http_fetcher.h"

namespace terrella {

/// Replies on their way from the threads that got them to the threads that deal with them. The network thread only
/// pushes, so nothing that a user of HttpFetcher does can hold that thread up. thread: any for every call
class ReplyQueue {
 public:
  /// Completes a reply with work that may block, such as reading a file.
  using Finish = std::function<void(HttpReply&)>;

  /// A push wakes a taker only if `wake_at` replies are there: to wake a thread for each costs as much as the rest of a
  /// small tile.
  explicit ReplyQueue(std::size_t wake_at = 1) : wake_at_(wake_at) {}

  /// A queue that keeps nothing: each push goes to `taker`, which must not block. For replies without a Finish.
  explicit ReplyQueue(std::function<void(HttpReply&&)> taker) : wake_at_(1), taker_(std::move(taker)) {}

  /// Never blocks. The thread that takes the reply runs `finish`, if any, before it gets the reply.
  void push(HttpReply&& reply, Finish finish = {});
  /// Waits for a reply. Nothing once close() was called.
  [[nodiscard]] std::optional<HttpReply> take();
  /// Returns all replies that are there; waits for `wake_at` of them, but no longer than `longest`.
  [[nodiscard]] std::vector<HttpReply> take_all(std::chrono::milliseconds longest);
  void close();  ///< take() returns nothing from now on

 private:
  struct Item {
    HttpReply reply;
    Finish finish;
  };
  [[nodiscard]] static HttpReply finished(Item&& item);

  const std::size_t wake_at_;
  const std::function<void(HttpReply&&)> taker_;  ///< empty: the queue keeps the replies
  std::mutex mutex_;                              ///< guards the members below
  std::condition_variable pushed_;
  std::deque<Item> items_;
  bool closed_ = false;
};

}  // namespace terrella
