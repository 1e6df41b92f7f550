#include "streaming/cut/output/encode_pool.h"

#include <system_error>

#include "streaming/cut/squeeze.h"

namespace terrella {
namespace {

/// The tiles of a strip come first, then its squeezed tiles.
TileId tile_of(const Strip& strip, std::int64_t index) {
  if (index < strip.tiles) return {.level = strip.level, .x = strip.tile_x0 + index, .y = strip.tile_y};
  return {.level = strip.level, .x = index - strip.tiles, .y = strip.tile_y, .squeeze = strip.squeeze};
}

}  // namespace

EncodePool::EncodePool(int jobs, TileCoding coding, TileWriter& writer, std::int64_t already)
    : writer_(writer), already_(static_cast<std::uint64_t>(already)), next_to_write_(already_) {
  try {
    threads_.emplace_back([this] { run_guarded([this] { run_writer(); }); });
    for (int i = 0; i < jobs; ++i) {
      threads_.emplace_back([this, coding] { run_guarded([&] { run_encoder(coding); }); });
    }
  } catch (const std::system_error&) {
    // One encoder is enough.
    if (threads_.size() > 1) return;
    fail(Error{"stopped"});
    join();
    throw;
  }
}

EncodePool::~EncodePool() {
  if (threads_.empty()) return;
  fail(Error{"stopped"});
  join();
}

void EncodePool::submit(const std::shared_ptr<const Strip>& strip) {
  {
    const std::scoped_lock lock(mutex_);
    if (error_) return;
    for (std::int64_t i = 0; i < strip->tiles + squeezed_tiles(*strip); ++i, ++submitted_) {
      if (submitted_ >= already_) jobs_.push_back({strip, i, submitted_});
    }
  }
  work_.notify_all();
}

bool EncodePool::failed() const {
  const std::scoped_lock lock(mutex_);
  return error_.has_value();
}

Result<TileCounts> EncodePool::finish() {
  {
    const std::scoped_lock lock(mutex_);
    closed_ = true;
  }
  join();
  if (thrown_) std::rethrow_exception(thrown_);
  if (error_) return *error_;
  return counts_;
}

void EncodePool::fail(const Error& error) {
  std::deque<Job> dropped;
  {
    const std::scoped_lock lock(mutex_);
    if (!error_) error_ = error;
    dropped.swap(jobs_);
  }
  work_.notify_all();
  encoded_.notify_all();
  written_.notify_all();
}

void EncodePool::join() {
  work_.notify_all();
  encoded_.notify_all();
  for (std::thread& thread : threads_) thread.join();
  threads_.clear();
}

/// Catches exceptions, because an exception that leaves a thread ends the program. finish() rethrows them.
void EncodePool::run_guarded(const std::function<void()>& work) {
  try {
    work();
  } catch (const std::exception&) {
    {
      const std::scoped_lock lock(mutex_);
      if (!thrown_) thrown_ = std::current_exception();
    }
    fail(Error{"stopped"});
  }
}

// ---- encoder threads

void EncodePool::run_encoder(const TileCoding& coding) {
  TileEncoder encoder(coding);
  while (true) {
    std::optional<Job> job;
    {
      std::unique_lock lock(mutex_);
      work_.wait(lock, [&] { return error_ || closed_ || !jobs_.empty(); });
      if (error_ || jobs_.empty()) return;
      job = std::move(jobs_.front());
      jobs_.pop_front();
      // The tile that the writer needs next never waits here.
      written_.wait(lock, [&] { return error_ || job->order < next_to_write_ + kMaxUnwrittenTiles; });
    }
    const TileId id = tile_of(*job->strip, job->index);
    auto bytes =
        id.squeeze == 0 ? encoder.encode(*job->strip, job->index) : encoder.encode(squeezed_tile(*job->strip, id.x), 0);
    job->strip.reset();
    if (!bytes) return fail(bytes.error());
    {
      const std::scoped_lock lock(mutex_);
      finished_.emplace(job->order, Encoded{id, *std::move(bytes)});
    }
    encoded_.notify_one();
  }
}

// ---- writer thread

void EncodePool::run_writer() {
  while (true) {
    Encoded tile;
    {
      std::unique_lock lock(mutex_);
      encoded_.wait(lock, [&] {
        return error_ || finished_.contains(next_to_write_) || (closed_ && next_to_write_ >= submitted_);
      });
      const auto found = finished_.find(next_to_write_);
      if (error_ || found == finished_.end()) return;
      tile = std::move(found->second);
      finished_.erase(found);
    }
    if (Status put = writer_.put(tile.id, tile.bytes); !put) return fail(put.error());
    {
      const std::scoped_lock lock(mutex_);
      ++next_to_write_;
      counts_.add(tile.id, tile.bytes.size());
    }
    written_.notify_all();
  }
}

}  // namespace terrella
