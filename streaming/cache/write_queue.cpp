#include "streaming/cache/write_queue.h"

#include <algorithm>

namespace terrella {
namespace {

using Clock = std::chrono::steady_clock;

/// A transaction costs as much as about ten tiles. The first tile therefore waits this long for others.
constexpr std::chrono::milliseconds kLinger{20};
/// Shortest interval between writes that contain only uses.
constexpr std::chrono::seconds kUsesWait{10};
constexpr std::size_t kMaxUses = 4096;

std::size_t bytes_of(const CacheChange& change) { return change.record ? change.record->bytes.size() : 0; }

}  // namespace

void WriteQueue::push(CacheChange change) {
  const std::size_t bytes = bytes_of(change);
  std::unique_lock lock(mutex_);
  if (std::this_thread::get_id() != writer_) {
    space_.wait(lock, [&] { return queued_bytes_ == 0 || queued_bytes_ + bytes <= limits_.queued_bytes || closed_; });
  }
  queued_bytes_ += bytes;
  ++pushed_;
  merge_pending(change);
  changes_.push_back(std::move(change));
  if (changes_.size() == 1 || changes_.size() >= limits_.batch_tiles) work_.notify_one();
}

/// Applies the rules of CacheRows::put() and renew(), so that readers find now the record that will be written.
void WriteQueue::merge_pending(const CacheChange& change) {
  if (change.pin) return;
  PendingRecord& pending = pending_[change.id];
  pending.last_change = pushed_;
  if (!change.record) {
    pending.renewal = change.renewal;
    return;
  }
  const CacheRecord& record = *change.record;
  if (record.missing && pending.record && !pending.record->missing) {
    if (record.missing == MissingKind::failed) return;
    const std::int64_t stored = pending.renewal ? pending.renewal->stored_unix_s : pending.record->stored_unix_s;
    pending.renewal = {stored, record.expires_unix_s};
    return;
  }
  // A renewal queued before a missing-tile record applies to the file, which may have a tile.
  if (!record.missing) pending.renewal.reset();
  if (pending.renewal && record.missing != MissingKind::failed) pending.renewal->expires_unix_s = record.expires_unix_s;
  pending.record = change.record;
}

void WriteQueue::note_use(std::int64_t row, std::int64_t used_unix_s) {
  const std::lock_guard lock(mutex_);
  if (uses_.empty()) first_use_noted_ = Clock::now();
  std::int64_t& used = uses_[row];
  used = std::max(used, used_unix_s);
  if (uses_.size() == kMaxUses) work_.notify_one();
}

bool WriteQueue::has_pending_in(int level, std::int64_t x, std::int64_t first_y, std::int64_t last_y) const {
  const std::lock_guard lock(mutex_);
  if (pending_.size() <= static_cast<std::size_t>(last_y - first_y)) {
    for (const auto& [id, record] : pending_) {
      if (id.level == level && id.x == x && id.y >= first_y && id.y <= last_y) return true;
    }
    return false;
  }
  for (std::int64_t y = first_y; y <= last_y; ++y) {
    if (pending_.contains({level, x, y})) return true;
  }
  return false;
}

std::optional<PendingRecord> WriteQueue::pending(const TileId& id) const {
  const std::lock_guard lock(mutex_);
  const auto found = pending_.find(id);
  return found == pending_.end() ? std::nullopt : std::optional(found->second);
}

bool WriteQueue::hurried() const {
  return closed_ || changes_.size() >= limits_.batch_tiles || flush_up_to_ > finished_ ||
         queued_bytes_ >= std::min(limits_.batch_bytes, limits_.queued_bytes / 2);
}

CacheBatch WriteQueue::take(Clock::time_point until) {
  std::unique_lock lock(mutex_);
  writer_ = std::this_thread::get_id();
  const auto uses_due = [&] {
    return uses_.size() >= kMaxUses || (!uses_.empty() && Clock::now() >= first_use_noted_ + kUsesWait);
  };
  while (changes_.empty() && !closed_ && !uses_due() && Clock::now() < until) {
    const auto next = uses_.empty() ? until : std::min(until, first_use_noted_ + kUsesWait);
    work_.wait_until(lock, next);
  }
  if (!changes_.empty()) work_.wait_until(lock, Clock::now() + kLinger, [&] { return hurried(); });
  return take_locked();
}

CacheBatch WriteQueue::take_locked() {
  CacheBatch batch;
  std::size_t bytes = 0;
  while (!changes_.empty() && batch.changes.size() < limits_.batch_tiles &&
         (bytes == 0 || bytes + bytes_of(changes_.front()) <= limits_.batch_bytes)) {
    bytes += bytes_of(changes_.front());
    batch.changes.push_back(std::move(changes_.front()));
    changes_.pop_front();
  }
  batch.last_change = pushed_ - changes_.size();
  batch.uses.assign(uses_.begin(), uses_.end());
  uses_.clear();
  batch.last = closed_ && changes_.empty();
  return batch;
}

void WriteQueue::finish(const CacheBatch& batch, const Status& status) {
  const std::lock_guard lock(mutex_);
  for (const CacheChange& change : batch.changes) {
    queued_bytes_ -= bytes_of(change);
    const auto found = pending_.find(change.id);
    if (found != pending_.end() && found->second.last_change <= batch.last_change) pending_.erase(found);
  }
  finished_ = batch.last_change;
  if (!status && !first_error_) first_error_ = status.error();
  space_.notify_all();
  done_.notify_all();
}

Status WriteQueue::flush() {
  std::unique_lock lock(mutex_);
  const std::uint64_t target = pushed_;
  flush_up_to_ = std::max(flush_up_to_, target);
  work_.notify_one();
  done_.wait(lock, [&] { return finished_ >= target; });
  if (!first_error_) return Done{};
  const Error error = *first_error_;
  first_error_.reset();
  return error;
}

void WriteQueue::close() {
  const std::lock_guard lock(mutex_);
  closed_ = true;
  work_.notify_one();
  space_.notify_all();
}

}  // namespace terrella
