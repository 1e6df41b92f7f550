// The functions of TileScheduler and Loader. tile_scheduler.h includes this file.

namespace terrella {

// ---- thread: main

template <class Decoded>
void TileScheduler<Decoded>::stop() {
  TileIdSet given_up;
  std::vector<Worker> workers;
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
    waiting_.clear();
    given_up.swap(fetching_);
    workers.swap(workers_);
  }
  stop_.request_stop();
  for (const TileId& id : given_up) remote_->cancel(id);
  work_changed_.notify_all();
  for (Worker& worker : workers) worker.is_busy ? end_late(std::move(worker.ended)) : worker.ended.wait();
}

template <class Decoded>
typename TileScheduler<Decoded>::Wishes TileScheduler<Decoded>::best_wishes(std::span<const TileRequest> wanted) {
  // A NaN would break the order of the list, so a NaN counts as the lowest priority.
  const auto rank = [](double priority) {
    return priority == priority ? priority : -std::numeric_limits<double>::infinity();
  };
  Wishes best;
  best.reserve(wanted.size());
  for (const TileRequest& request : wanted) {
    const auto [entry, is_new] = best.try_emplace(request.id, rank(request.priority));
    if (!is_new) entry->second = std::max(entry->second, rank(request.priority));
  }
  return best;
}

template <class Decoded>
void TileScheduler<Decoded>::request(std::span<const TileRequest> wanted) {
  const Wishes best = best_wishes(wanted);
  std::vector<TileRequest> wishes;
  wishes.reserve(best.size());
  for (const auto& [id, priority] : best) wishes.push_back({id, priority});
  // Ties are sorted by id, so that the reading order does not depend on a hash.
  std::sort(wishes.begin(), wishes.end(), [](const TileRequest& a, const TileRequest& b) {
    return a.priority != b.priority ? a.priority < b.priority : a.id > b.id;
  });
  std::vector<TileId> dropped;
  std::vector<TileRequest> moved;
  {
    const std::lock_guard lock(mutex_);
    std::erase_if(arrived_, [&](const Arrived& tile) { return !best.contains(tile.id); });
    for (const TileId& id : fetching_) {
      const auto wish = best.find(id);
      wish == best.end() ? dropped.push_back(id) : moved.push_back({id, wish->second});
    }
    for (const TileId& id : dropped) fetching_.erase(id);
    std::erase_if(wishes, [&](const TileRequest& wish) { return under_way(wish.id); });
    waiting_.swap(wishes);
  }
  // Without the lock: a thread of the source may be about to take it.
  for (const TileId& id : dropped) remote_->cancel(id);
  for (const TileRequest& wish : moved) remote_->set_priority(wish.id, wish.priority);
  work_changed_.notify_all();
}

template <class Decoded>
void TileScheduler<Decoded>::reread(const TileId& id) {
  const auto is_it = [&id](const auto& tile) { return tile.id == id; };
  bool is_fetching = false;
  {
    const std::lock_guard lock(mutex_);
    std::erase_if(arrived_, is_it);
    if (running_.contains(id)) outdated_.insert(id);
    is_fetching = fetching_.erase(id) > 0;
    if (const auto found = std::ranges::find_if(finished_, is_it); found != finished_.end()) {
      finished_bytes_ -= weight_bytes(*found);
      finished_ids_.erase(id);
      finished_.erase(found);
    }
  }
  if (is_fetching) remote_->cancel(id);
  work_changed_.notify_all();
}

template <class Decoded>
bool TileScheduler<Decoded>::under_way(const TileId& id) const {
  return running_.contains(id) || fetching_.contains(id) || finished_ids_.contains(id) ||
         std::ranges::any_of(arrived_, [&id](const Arrived& tile) { return tile.id == id; });
}

template <class Decoded>
std::vector<typename TileScheduler<Decoded>::Finished> TileScheduler<Decoded>::poll(std::size_t max_bytes) {
  std::vector<Finished> taken;
  std::size_t taken_bytes = 0;
  {
    const std::lock_guard lock(mutex_);
    while (!finished_.empty()) {
      const std::size_t bytes = weight_bytes(finished_.front());
      if (!taken.empty() && taken_bytes + bytes > max_bytes) break;
      taken_bytes += bytes;
      finished_ids_.erase(finished_.front().id);
      taken.push_back(std::move(finished_.front()));
      finished_.pop_front();
    }
    finished_bytes_ -= taken_bytes;
  }
  work_changed_.notify_all();
  return taken;
}

template <class Decoded>
bool TileScheduler<Decoded>::wait(std::chrono::steady_clock::time_point deadline) {
  std::unique_lock lock(mutex_);
  finished_changed_.wait_until(lock, deadline, [this] {
    return !finished_.empty() || (waiting_.empty() && running_.empty() && fetching_.empty() && arrived_.empty());
  });
  return !finished_.empty();
}

template <class Decoded>
LoaderCounts TileScheduler<Decoded>::counts() const {
  const std::lock_guard lock(mutex_);
  return {.waiting = waiting_.size(),
          .running = running_.size() + arrived_.size(),
          .fetching = fetching_.size(),
          .finished = finished_.size(),
          .read = read_,
          .missing = missing_};
}

// ---- thread: worker

template <class Decoded>
void TileScheduler<Decoded>::work(std::size_t worker) {
  std::unique_lock lock(mutex_);
  while (true) {
    work_changed_.wait(lock, [this] { return stopping_ || may_start(); });
    if (stopping_) return;
    workers_[worker].is_busy = true;
    // Arrived tiles come first: they hold memory, and the screen waits for them.
    if (!arrived_.empty()) {
      const Arrived tile = std::move(arrived_.front());
      arrived_.pop_front();
      running_.insert(tile.id);
      decode(lock, tile);
    } else {
      const TileRequest wish = waiting_.back();
      waiting_.pop_back();
      running_.insert(wish.id);
      look_for(lock, wish);
    }
    if (stopping_) return;
    workers_[worker].is_busy = false;
  }
}

/// Reads a tile, and asks the network for the tile if the source does not have it locally.
template <class Decoded>
void TileScheduler<Decoded>::look_for(std::unique_lock<std::mutex>& lock, const TileRequest& wish) {
  lock.unlock();
  const std::uint64_t edition = source_->edition();
  Encoded encoded = read(wish.id);
  const bool is_remote = !encoded && encoded.error().kind == MissingKind::remote;
  lock.lock();
  if (!is_remote || remote_ == nullptr) return decode(lock, {wish.id, std::move(encoded), edition});
  running_.erase(wish.id);
  outdated_.erase(wish.id);  // it is fetched from now on
  if (stopping_) return;
  fetching_.insert(wish.id);
  lock.unlock();
  // The answer may come after this loader is gone.
  try {
    remote_->fetch(wish.id, wish.priority, [loader = this->weak_from_this(), id = wish.id, edition](Encoded answer) {
      if (const auto self = loader.lock()) self->arrive({id, std::move(answer), edition});
    });
  } catch (...) {
    arrive({wish.id, caught_failure(), edition});
  }
  lock.lock();
}

template <class Decoded>
typename TileScheduler<Decoded>::Encoded TileScheduler<Decoded>::read(const TileId& id) {
  try {
    return source_->read_or_stop(id, stop_.get_token());
  } catch (...) {
    return caught_failure();
  }
}

template <class Decoded>
void TileScheduler<Decoded>::decode(std::unique_lock<std::mutex>& lock, const Arrived& tile) {
  lock.unlock();
  Finished finished{tile.id, decoded(tile), tile.edition};
  lock.lock();
  running_.erase(tile.id);
  if (outdated_.erase(tile.id) > 0) {
    waiting_.push_back({tile.id, std::numeric_limits<double>::infinity()});
    work_changed_.notify_one();
    return;
  }
  ++read_;
  if (!finished.tile) ++missing_;
  finished_bytes_ += weight_bytes(finished);
  finished_ids_.insert(tile.id);
  finished_.push_back(std::move(finished));
  finished_changed_.notify_all();
  if (bell_) bell_->ring();
}

template <class Decoded>
Result<Decoded, TileFailure> TileScheduler<Decoded>::decoded(const Arrived& tile) const {
  if (!tile.encoded) return tile.encoded.error();
  try {
    return decode_(tile.id, *tile.encoded);
  } catch (...) {
    return caught_failure();
  }
}

// ---- thread: a thread of the source

template <class Decoded>
void TileScheduler<Decoded>::arrive(Arrived tile) {
  {
    const std::lock_guard lock(mutex_);
    if (fetching_.erase(tile.id) == 0) return;
    arrived_.push_back(std::move(tile));
  }
  work_changed_.notify_one();
}

// ---- Loader

template <class Decoded>
std::shared_ptr<TileScheduler<Decoded>> start_scheduler(std::shared_ptr<TileSource> source, int workers,
                                                        std::size_t max_finished_bytes,
                                                        std::shared_ptr<ArrivalBell> bell,
                                                        typename TileScheduler<Decoded>::Decode decode) {
  assert(source != nullptr);
  assert(workers >= 1 && workers <= 64);
  auto scheduler = std::make_shared<TileScheduler<Decoded>>(std::move(source), std::move(decode), max_finished_bytes,
                                                            std::move(bell));
  scheduler->start(workers);
  return scheduler;
}

template <class Decoded>
Loader<Decoded>::~Loader() {
  if (scheduler_) scheduler_->stop();
}

template <class Decoded>
void Loader<Decoded>::request(std::span<const TileRequest> wanted) {
  scheduler_->request(wanted);
}

template <class Decoded>
void Loader<Decoded>::reread(const TileId& id) {
  scheduler_->reread(id);
}

template <class Decoded>
std::vector<Loaded<Decoded>> Loader<Decoded>::poll(std::size_t max_bytes) {
  return scheduler_->poll(max_bytes);
}

template <class Decoded>
bool Loader<Decoded>::wait(std::chrono::steady_clock::time_point deadline) {
  return scheduler_->wait(deadline);
}

template <class Decoded>
LoaderCounts Loader<Decoded>::counts() const {
  return scheduler_->counts();
}

}  // namespace terrella
