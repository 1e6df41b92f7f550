#include "streaming/warp/block_fetcher.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace terrella {

BlockFetcher::BlockFetcher(std::shared_ptr<const StoredBlocks> blocks, MakeJob make_job, bool numbers)
    : blocks_(std::move(blocks)),
      network_(*blocks_->network()),
      make_job_(std::move(make_job)),
      numbers_(numbers),
      desk_({.work = [this](const TileWish& wish) { return work(wish); },
             .moved = [this](const TileWish& wish) { move(wish); },
             .ended = [this](const TileWish& wish, bool) { stop_waiting(wish.number); }}) {}

/// Goes on with a tile until it is finished, or waits for the network.
std::optional<BlockFetcher::Encoded> BlockFetcher::work(const TileWish& wish) {
  Tile& tile = tile_of(wish);
  if (!tile.job) {
    auto job = make_job_(wish.id);
    if (!job) return job.error();
    tile.job.emplace(*std::move(job));
  }
  const std::vector<TileId> missing = look(tile);
  if (missing.empty()) return tile.job->result(numbers_);
  if (desk_.is_wanted(wish.number)) wait_for(wish, tile, missing);
  return std::nullopt;
}

BlockFetcher::Tile& BlockFetcher::tile_of(const TileWish& wish) {
  const std::lock_guard lock(mutex_);
  const auto [tile, is_new] = tiles_.try_emplace(wish.number);
  if (is_new) tile->second.priority = wish.priority;
  return tile->second;
}

/// Settles the answers that came and looks for blocks that are not known. Other wishes may have brought a missing block
/// during the look, so it looks for a second time. Returns what has to be fetched.
std::vector<TileId> BlockFetcher::look(Tile& tile) {
  std::vector<TileId> missing;
  std::vector<TileId> came;
  std::unique_lock lock(mutex_);
  for (int again = 0; again < 2; ++again) {
    const std::vector<Answer> answers = std::exchange(tile.answers, {});
    const std::uint64_t arrivals = arrivals_;
    lock.unlock();
    for (const Answer& answer : answers) tile.job->settle(answer.stored, answer.found);
    for (const TileId& stored : came) tile.job->look_again(stored);
    tile.job->advance();
    missing = tile.job->missing();
    lock.lock();
    if (arrivals == arrivals_) break;
    came.clear();
    std::ranges::copy_if(missing, std::back_inserter(came),
                         [this](const TileId& stored) { return !waiting_.contains(stored); });
    if (came.empty()) break;
  }
  return missing;
}

/// Does nothing if an answer came meanwhile: the desk then goes on with the wish.
void BlockFetcher::wait_for(const TileWish& wish, Tile& tile, const std::vector<TileId>& missing) {
  std::vector<TileId> unasked;
  double priority = 0.0;
  {
    const std::lock_guard lock(mutex_);
    if (!tile.answers.empty()) return;
    tile.missing = missing;
    priority = tile.priority;
    for (const TileId& stored : missing) {
      const auto [waiting, is_new] = waiting_.try_emplace(stored);
      if (std::ranges::find(waiting->second, wish.number) == waiting->second.end())
        waiting->second.push_back(wish.number);
      is_new ? unasked.push_back(stored) : network_.set_priority(stored, priority_of(stored));
    }
  }
  for (const TileId& stored : unasked) ask(stored, priority);
}

void BlockFetcher::ask(const TileId& stored, double priority) {
  try {
    network_.fetch(stored, priority, [fetcher = weak_from_this(), stored](Encoded answer) {
      if (const auto self = fetcher.lock()) self->arrive(stored, std::move(answer));
    });
  } catch (...) {
    arrive(stored, caught_failure());
  }
}

void BlockFetcher::move(const TileWish& wish) {
  const std::lock_guard lock(mutex_);
  Tile& tile = tiles_[wish.number];
  tile.priority = wish.priority;
  for (const TileId& stored : tile.missing) {
    if (waiting_.contains(stored)) network_.set_priority(stored, priority_of(stored));  // else it has come
  }
}

double BlockFetcher::priority_of(const TileId& stored) const {
  double most = -std::numeric_limits<double>::infinity();
  for (const std::uint64_t wish : waiting_.at(stored)) most = std::max(most, tiles_.at(wish).priority);
  return most;
}

void BlockFetcher::stop_waiting(std::uint64_t wish) {
  const std::lock_guard lock(mutex_);
  const auto tile = tiles_.extract(wish);
  if (tile.empty()) return;
  for (const TileId& stored : tile.mapped().missing) {
    const auto waiting = waiting_.find(stored);
    if (waiting == waiting_.end()) continue;
    std::erase(waiting->second, wish);
    if (!waiting->second.empty()) continue;
    waiting_.erase(waiting);
    network_.cancel(stored);
  }
}

void BlockFetcher::arrive(const TileId& stored, Encoded&& answer) {
  const FoundBlock found = FoundBlock::of(std::move(answer));
  std::vector<std::uint64_t> wishes;
  {
    const std::lock_guard lock(mutex_);
    ++arrivals_;
    const auto waiting = waiting_.extract(stored);
    if (waiting.empty()) return;
    wishes = waiting.mapped();
    for (const std::uint64_t wish : wishes) tiles_.at(wish).answers.push_back({stored, found});
  }
  for (const std::uint64_t wish : wishes) desk_.resume(wish);
}

}  // namespace terrella
