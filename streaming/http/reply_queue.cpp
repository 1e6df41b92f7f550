#include "streaming/http/reply_queue.h"

#include <exception>
#include <utility>

namespace terrella {

void ReplyQueue::push(HttpReply&& reply, Finish finish) {
  if (taker_) return taker_(std::move(reply));
  const std::lock_guard lock(mutex_);
  items_.push_back({std::move(reply), std::move(finish)});
  if (items_.size() >= wake_at_) pushed_.notify_one();
}

std::optional<HttpReply> ReplyQueue::take() {
  std::unique_lock lock(mutex_);
  pushed_.wait(lock, [this] { return closed_ || !items_.empty(); });
  if (closed_) return std::nullopt;
  Item item = std::move(items_.front());
  items_.pop_front();
  lock.unlock();
  return finished(std::move(item));
}

std::vector<HttpReply> ReplyQueue::take_all(std::chrono::milliseconds longest) {
  std::deque<Item> items;
  {
    std::unique_lock lock(mutex_);
    pushed_.wait_for(lock, longest, [this] { return items_.size() >= wake_at_; });
    items.swap(items_);
  }
  std::vector<HttpReply> replies;
  replies.reserve(items.size());
  for (Item& item : items) replies.push_back(finished(std::move(item)));
  return replies;
}

void ReplyQueue::close() {
  const std::lock_guard lock(mutex_);
  closed_ = true;
  pushed_.notify_all();
}

HttpReply ReplyQueue::finished(Item&& item) {
  try {
    if (item.finish) item.finish(item.reply);
  } catch (const std::exception& failed) {
    item.reply.outcome = HttpOutcome::failed;
    item.reply.why = failed.what();
  }
  return std::move(item.reply);
}

}  // namespace terrella
