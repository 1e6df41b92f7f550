#include "tiles/request_desk.h"

#include <system_error>
#include <utility>

#include "tiles/late_workers.h"

namespace terrella {

void RequestDesk::fetch(const TileId& id, double priority, Done done) {
  Done replaced;  // may hold a source, which must not end under the lock
  const std::lock_guard lock(mutex_);
  if (*closed_) return;
  if (threads_.empty()) start_threads();
  if (const auto earlier = wishes_.find(id); earlier != wishes_.end()) replaced = remove(earlier, false);
  const std::uint64_t number = ++last_number_;
  ids_.emplace(number, id);
  resume(wishes_.emplace(id, Entry{{.number = number, .id = id, .priority = priority}, std::move(done)}).first->second);
}

void RequestDesk::set_priority(const TileId& id, double priority) {
  const std::lock_guard lock(mutex_);
  const auto entry = wishes_.find(id);
  if (entry == wishes_.end()) return;
  entry->second.wish.priority = priority;
  if (parts_.moved) parts_.moved(entry->second.wish);
}

void RequestDesk::cancel(const TileId& id) {
  Done given_up;
  const std::lock_guard lock(mutex_);
  if (const auto entry = wishes_.find(id); entry != wishes_.end()) given_up = remove(entry, false);
}

void RequestDesk::resume(std::uint64_t number, Work next) {
  const std::lock_guard lock(mutex_);
  if (const auto id = ids_.find(number); id != ids_.end()) resume(wishes_.at(id->second), std::move(next));
}

void RequestDesk::resume(const TileId& id) {
  const std::lock_guard lock(mutex_);
  if (const auto entry = wishes_.find(id); entry != wishes_.end()) resume(entry->second);
}

void RequestDesk::resume_all() {
  const std::lock_guard lock(mutex_);
  for (auto& [id, entry] : wishes_) resume(entry);
}

void RequestDesk::resume(Entry& entry, Work next) {
  if (next || entry.next.empty() || entry.next.back()) entry.next.push_back(std::move(next));
  if (!entry.in_work) ready_.notify_one();
}

bool RequestDesk::is_wanted(std::uint64_t number) const {
  const std::lock_guard lock(mutex_);
  return ids_.contains(number);
}

void RequestDesk::close() {
  std::vector<Done> given_up;
  std::vector<Thread> threads;
  {
    const std::lock_guard lock(mutex_);
    *closed_ = true;
    while (!wishes_.empty()) given_up.push_back(remove(wishes_.begin(), false));
    threads.swap(threads_);
    ready_.notify_all();
  }
  for (Thread& thread : threads) {
    thread.id == std::this_thread::get_id() ? end_late(std::move(thread.ended)) : thread.ended.wait();
  }
}

void RequestDesk::start_threads() {
  threads_.reserve(static_cast<std::size_t>(parts_.threads));
  for (int i = 0; i < parts_.threads; ++i) {
    try {
      threads_.push_back(
          {.ended = std::async(std::launch::async, [this, i] { run(static_cast<std::size_t>(i)); }), .id = {}});
    } catch (const std::system_error&) {
      if (threads_.empty()) throw;
      return;  // the system has no more threads; work with fewer
    }
  }
}

RequestDesk::Entries::iterator RequestDesk::most_wanted() {
  auto best = wishes_.end();
  for (auto at = wishes_.begin(); at != wishes_.end(); ++at) {
    const Entry& entry = at->second;
    if (entry.in_work || entry.next.empty() || (entry.wish.is_new && beginning_ >= parts_.beginners)) continue;
    if (best == wishes_.end() || entry.wish.priority > best->second.wish.priority) best = at;
  }
  return best;
}

/// The end of a wish that is in work is told after the work.
RemoteTiles::Done RequestDesk::remove(Entries::iterator entry, bool is_answered) {
  Entry removed = std::move(wishes_.extract(entry).mapped());
  ids_.erase(removed.wish.number);
  if (!removed.in_work && parts_.ended) parts_.ended(removed.wish, is_answered);
  return std::move(removed.done);
}

// ---- thread: the desk's

/// Touches nothing of the desk after an answer that has ended it.
void RequestDesk::run(std::size_t thread) {
  const auto closed = closed_;
  {
    const std::lock_guard lock(mutex_);
    if (*closed) return;
    threads_[thread].id = std::this_thread::get_id();
  }
  while (!*closed) {
    auto task = next();
    if (!task) return;
    auto answer = worked(*task);
    task->works.clear();
    const Done done = put_back(task->wish, answer.has_value());
    if (done) done(*std::move(answer));
  }
}

std::optional<RequestDesk::Task> RequestDesk::next() {
  std::unique_lock lock(mutex_);
  auto entry = wishes_.end();
  ready_.wait(lock, [&] { return *closed_ || (entry = most_wanted()) != wishes_.end(); });
  if (*closed_) return std::nullopt;
  entry->second.in_work = true;
  Task task{entry->second.wish, std::exchange(entry->second.next, {})};
  entry->second.wish.is_new = false;
  if (task.wish.is_new) ++beginning_;
  return task;
}

std::optional<RequestDesk::Answer> RequestDesk::worked(const Task& task) const {
  try {
    for (const Work& work : task.works) {
      if (auto answer = work ? work(task.wish) : parts_.work(task.wish)) return answer;
    }
    return std::nullopt;
  } catch (...) {
    return caught_failure();
  }
}

/// Returns what to call with the answer: nothing if there is none, or if the wish was given up meanwhile.
RemoteTiles::Done RequestDesk::put_back(const TileWish& wish, bool is_answered) {
  const std::lock_guard lock(mutex_);
  if (wish.is_new) {
    --beginning_;
    ready_.notify_one();  // another new wish may begin
  }
  const auto entry = wishes_.find(wish.id);
  if (entry == wishes_.end() || entry->second.wish.number != wish.number) {
    if (parts_.ended) parts_.ended(wish, false);
    return {};
  }
  entry->second.in_work = false;
  if (is_answered) return remove(entry, true);
  if (!entry->second.next.empty()) ready_.notify_one();
  return {};
}

}  // namespace terrella
