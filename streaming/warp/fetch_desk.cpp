#include "streaming/warp/fetch_desk.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace terrella {

void FetchDesk::fetch(const TileId& id, WarpJob job, double priority, RemoteTiles::Done done) {
  auto wish = std::make_shared<Wish>(std::move(job), priority, std::move(done));
  Lock lock(mutex_);
  wishes_.insert_or_assign(id, wish);
  work_on(lock, id, wish);
}

void FetchDesk::set_priority(const TileId& id, double priority) {
  const std::lock_guard lock(mutex_);
  const auto wish = wishes_.find(id);
  if (wish == wishes_.end()) return;
  wish->second->priority = priority;
  for (const TileId& stored : wish->second->missing) {
    if (waiting_.contains(stored)) network_.set_priority(stored, priority_of(stored));  // else it has come
  }
}

void FetchDesk::cancel(const TileId& id) {
  const std::lock_guard lock(mutex_);
  const auto wish = wishes_.extract(id);
  if (!wish.empty()) stop_waiting(id, wish.mapped()->missing);
}

void FetchDesk::close() {
  Lock lock(mutex_);
  closed_ = true;
  for (const auto& [stored, waiting] : waiting_) network_.cancel(stored);
  waiting_.clear();
  wishes_.clear();
  idle_.wait(lock, [this] { return working_ == 0; });
}

/// Goes on with a wish until it is finished, or waits for the network. Only one thread does so at a time.
void FetchDesk::work_on(Lock& lock, const TileId& id, const std::shared_ptr<Wish>& wish) {
  if (closed_ || std::exchange(wish->in_work, true)) return;
  ++working_;
  bool finished = false;
  while (is_wanted(id, wish) && !finished) {
    const std::vector<TileId> missing = look(lock, *wish);
    if (!is_wanted(id, wish)) break;
    finished = missing.empty();
    if (finished) {
      stop_waiting(id, wishes_.extract(id).mapped()->missing);
    } else if (wish->answers.empty()) {
      wait_for(lock, id, *wish, missing);
      if (wish->answers.empty()) break;
    }
  }
  wish->in_work = false;
  if (--working_ == 0) idle_.notify_all();
  lock.unlock();
  if (finished) wish->done(wish->job.result(numbers_));
}

bool FetchDesk::is_wanted(const TileId& id, const std::shared_ptr<Wish>& wish) const {
  const auto found = wishes_.find(id);
  return !closed_ && found != wishes_.end() && found->second == wish;
}

/// Settles the answers that came and looks for blocks that are not known. Gives up the lock meanwhile. Other wishes may
/// have brought a missing block during the look, so it looks for a second time. Returns what has to be fetched.
std::vector<TileId> FetchDesk::look(Lock& lock, Wish& wish) {
  std::vector<TileId> missing;
  std::vector<TileId> came;
  for (int again = 0; again < 2; ++again) {
    const std::vector<Answer> answers = std::exchange(wish.answers, {});
    const std::uint64_t arrivals = arrivals_;
    lock.unlock();
    for (const Answer& answer : answers) wish.job.settle(answer.stored, answer.found);
    for (const TileId& stored : came) wish.job.look_again(stored);
    wish.job.advance();
    missing = wish.job.missing();
    lock.lock();
    came.clear();
    if (arrivals == arrivals_) break;
    std::ranges::copy_if(missing, std::back_inserter(came),
                         [this](const TileId& stored) { return !waiting_.contains(stored); });
    if (came.empty() || closed_) break;
  }
  return missing;
}

double FetchDesk::priority_of(const TileId& stored) const {
  double most = -std::numeric_limits<double>::infinity();
  for (const TileId& id : waiting_.at(stored)) most = std::max(most, wishes_.at(id)->priority);
  return most;
}

/// Gives up the lock while it asks the network.
void FetchDesk::wait_for(Lock& lock, const TileId& id, Wish& wish, const std::vector<TileId>& missing) {
  std::vector<TileId> unasked;
  wish.missing = missing;
  for (const TileId& stored : missing) {
    const auto [waiting, is_new] = waiting_.try_emplace(stored);
    if (std::ranges::find(waiting->second, id) == waiting->second.end()) waiting->second.push_back(id);
    is_new ? unasked.push_back(stored) : network_.set_priority(stored, priority_of(stored));
  }
  const double priority = wish.priority;
  lock.unlock();
  for (const TileId& stored : unasked) {
    network_.fetch(stored, priority, [desk = weak_from_this(), stored](Encoded answer) {
      if (const auto self = desk.lock()) self->arrive(stored, std::move(answer));
    });
  }
  lock.lock();
  for (const TileId& stored : unasked) {
    if (!waiting_.contains(stored)) network_.cancel(stored);  // given up meanwhile, or here already
  }
}

void FetchDesk::stop_waiting(const TileId& id, const std::vector<TileId>& missing) {
  for (const TileId& stored : missing) {
    const auto waiting = waiting_.find(stored);
    if (waiting == waiting_.end()) continue;
    std::erase(waiting->second, id);
    if (!waiting->second.empty()) continue;
    waiting_.erase(waiting);
    network_.cancel(stored);
  }
}

void FetchDesk::arrive(const TileId& stored, Encoded&& answer) {
  const FoundBlock found = FoundBlock::of(std::move(answer));
  std::vector<std::pair<TileId, std::shared_ptr<Wish>>> wishes;
  Lock lock(mutex_);
  ++arrivals_;
  const auto waiting = waiting_.extract(stored);
  if (waiting.empty()) return;
  for (const TileId& id : waiting.mapped()) {
    const std::shared_ptr<Wish>& wish = wishes_.at(id);
    wish->answers.push_back({stored, found});
    wishes.emplace_back(id, wish);
  }
  for (const auto& [id, wish] : wishes) {
    if (!lock.owns_lock()) lock.lock();
    work_on(lock, id, wish);
  }
}

}  // namespace terrella
