#include <algorithm>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <stop_token>
#include <thread>
#include <utility>
#include <vector>

#include "streaming/preload/tile_origin.h"
#include "streaming/remote/reply_rules.h"

namespace terrella {
namespace {

HttpReply answer_to(const TileQuestion& question, TileSource& source) {
  auto tile = source.read(question.id);
  HttpReply reply;
  reply.id = question.number;
  reply.outcome = HttpOutcome::content;
  reply.attempts = 1;
  if (tile) {
    reply.body = std::move(tile->bytes);
    check_body(source.info(), question.id, reply);
    return reply;
  }
  reply.why = tile.error().why;
  switch (tile.error().kind) {
    case MissingKind::absent:
      reply.outcome = HttpOutcome::nothing;
      break;
    case MissingKind::blank:  // content of no bytes
      break;
    case MissingKind::broken:
      reply.outcome = HttpOutcome::broken;
      break;
    case MissingKind::failed:
    case MissingKind::remote:
      reply.outcome = HttpOutcome::failed;
      break;
  }
  return reply;
}

class DiskOrigin : public TileOrigin {
 public:
  DiskOrigin(std::shared_ptr<TileSource> source, int threads, ReplyQueue& answers)
      : source_(std::move(source)), answers_(answers) {
    for (int i = 0; i < std::clamp(threads, 1, 64); ++i) {
      threads_.emplace_back([this](const std::stop_token& stop) { read_all(stop); });
    }
  }

  void ask(TileQuestion question) override {
    {
      const std::lock_guard lock(mutex_);
      waiting_.push_back(std::move(question));
    }
    work_.notify_one();
  }
  void withdraw(std::uint64_t number) override {
    const std::lock_guard lock(mutex_);
    std::erase_if(waiting_, [number](const TileQuestion& question) { return question.number == number; });
  }
  [[nodiscard]] HttpCounts counts() const override {
    const std::lock_guard lock(mutex_);
    HttpCounts counts = counts_;
    counts.waiting = waiting_.size();
    return counts;
  }

 private:
  void read_all(const std::stop_token& stop) {
    std::unique_lock lock(mutex_);
    while (work_.wait(lock, stop, [this] { return !waiting_.empty(); })) {
      const TileQuestion question = std::move(waiting_.front());
      waiting_.pop_front();
      ++counts_.in_flight;
      ++counts_.requests;
      lock.unlock();
      HttpReply reply = answer_to(question, *source_);
      const std::size_t bytes = reply.body.size();
      answers_.push(std::move(reply));
      lock.lock();
      --counts_.in_flight;
      counts_.body_bytes += bytes;
    }
  }

  std::shared_ptr<TileSource> source_;
  ReplyQueue& answers_;
  mutable std::mutex mutex_;
  std::condition_variable_any work_;
  std::deque<TileQuestion> waiting_;
  HttpCounts counts_;
  std::vector<std::jthread> threads_;
};

}  // namespace

std::unique_ptr<TileOrigin> disk_origin(std::shared_ptr<TileSource> source, int threads, ReplyQueue& answers) {
  return std::make_unique<DiskOrigin>(std::move(source), threads, answers);
}

}  // namespace terrella
