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
  const std::uint64_t arrivals = settle(tile);
  tile.job->advance();
  const std::vector<TileId> missing = tile.job->missing();
  if (missing.empty()) return tile.job->result(numbers_);
  if (desk_.is_wanted(wish.number)) wait_for(wish, tile, missing, arrivals);
  return std::nullopt;
}

BlockFetcher::Tile& BlockFetcher::tile_of(const TileWish& wish) {
  const std::lock_guard lock(mutex_);
  const auto [tile, is_new] = tiles_.try_emplace(wish.number);
  if (is_new) tile->second.priority = wish.priority;
  return tile->second;
}

/// Settles the answers that came. Returns the count of all answers so far.
std::uint64_t BlockFetcher::settle(Tile& tile) {
  std::vector<Answer> answers;
  std::uint64_t arrivals = 0;
  {
    const std::lock_guard lock(mutex_);
    answers.swap(tile.answers);
    arrivals = arrivals_;
  }
  for (const Answer& answer : answers) tile.job->settle(answer.stored, answer.found);
  return arrivals;
}

/// Does nothing if an answer came meanwhile: the desk then goes on with the wish. `arrivals`: the count of answers
/// before the blocks were looked up.
void BlockFetcher::wait_for(const TileWish& wish, Tile& tile, const std::vector<TileId>& missing,
                            std::uint64_t arrivals) {
  std::vector<TileId> unasked;
  double priority = 0.0;
  bool may_have_come = false;
  {
    const std::lock_guard lock(mutex_);
    if (!tile.answers.empty()) return;
    tile.missing = missing;
    priority = tile.priority;
    may_have_come = arrivals != arrivals_;
    for (const TileId& stored : missing) {
      const auto [waiting, is_new] = waiting_.try_emplace(stored);
      if (std::ranges::find(waiting->second, wish.number) == waiting->second.end())
        waiting->second.push_back(wish.number);
      is_new ? unasked.push_back(stored) : network_.set_priority(stored, priority_of(stored));
    }
  }
  for (const TileId& stored : unasked) ask(stored, priority, may_have_come);
}

/// Looks the block up once more if another wish may have brought it since the first look.
void BlockFetcher::ask(const TileId& stored, double priority, bool may_have_come) {
  try {
    Encoded here = may_have_come ? blocks_->read(stored) : TileFailure{MissingKind::remote, {}};
    if (here || here.error().kind != MissingKind::remote) return arrive(stored, std::move(here));
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
