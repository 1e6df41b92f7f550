#include "streaming/tile_loader.h"

#include <algorithm>
#include <cassert>
#include <condition_variable>
#include <deque>
#include <exception>
#include <limits>
#include <mutex>
#include <thread>
#include <unordered_map>
#include <unordered_set>
#include <utility>

namespace terrella {
namespace {

using TileIdSet = std::unordered_set<TileId, TileIdHash>;

/// A NaN would break the order of the list: it comes last.
double rank(double priority) { return priority == priority ? priority : -std::numeric_limits<double>::infinity(); }

/// What a finished tile counts against the bound. One without pixels counts a little, so that they are bounded too.
std::size_t weight_bytes(const LoadedTile& tile) {
  constexpr std::size_t kFailureBytes = 1024;
  return tile.pixels ? size_bytes(*tile.pixels) : kFailureBytes;
}

}  // namespace

struct TileLoader::Impl {
  Impl(std::shared_ptr<TileSource> tile_source, const LoaderOptions& loader_options)
      : source(std::move(tile_source)), options(loader_options) {}

  // thread: main ----------------------------------------------------------------------------------------------------
  void start();
  void stop();
  void replace_wishes(std::span<const TileRequest> wanted);
  [[nodiscard]] std::vector<LoadedTile> take(std::size_t max_bytes);

  // thread: worker --------------------------------------------------------------------------------------------------
  void work();
  [[nodiscard]] Result<TileTexels, TileFailure> load(const TileId& id);
  [[nodiscard]] Result<TileTexels, TileFailure> load_without_throwing(const TileId& id);
  [[nodiscard]] bool may_start() const { return !waiting.empty() && finished_bytes < options.max_finished_bytes; }

  const std::shared_ptr<TileSource> source;
  const LoaderOptions options;

  mutable std::mutex mutex;  ///< guards all below but `workers`
  std::condition_variable work_changed;
  std::condition_variable finished_changed;
  bool stopping = false;
  std::vector<TileRequest> waiting;  ///< ascending priority: the next one is the last
  TileIdSet running;
  TileIdSet finished_ids;
  std::deque<LoadedTile> finished;
  std::size_t finished_bytes = 0;
  std::size_t read = 0;
  std::size_t lacked = 0;

  std::vector<std::thread> workers;
};

void TileLoader::Impl::start() {
  for (int i = 0; i < options.workers; ++i) workers.emplace_back([this] { work(); });
}

void TileLoader::Impl::stop() {
  {
    const std::lock_guard lock(mutex);
    stopping = true;
    waiting.clear();
  }
  work_changed.notify_all();
  for (std::thread& worker : workers) worker.join();
}

void TileLoader::Impl::replace_wishes(std::span<const TileRequest> wanted) {
  std::unordered_map<TileId, double, TileIdHash> best;
  best.reserve(wanted.size());
  for (const TileRequest& request : wanted) {
    const auto [entry, is_new] = best.try_emplace(request.id, rank(request.priority));
    if (!is_new) entry->second = std::max(entry->second, rank(request.priority));
  }
  std::vector<TileRequest> wishes;
  wishes.reserve(best.size());
  for (const auto& [id, priority] : best) wishes.push_back({id, priority});
  // The identity settles ties, so that the order of reading does not hang on a hash.
  std::sort(wishes.begin(), wishes.end(), [](const TileRequest& a, const TileRequest& b) {
    return a.priority != b.priority ? a.priority < b.priority : a.id > b.id;
  });
  {
    const std::lock_guard lock(mutex);
    std::erase_if(wishes,
                  [&](const TileRequest& wish) { return running.contains(wish.id) || finished_ids.contains(wish.id); });
    waiting.swap(wishes);
  }
  work_changed.notify_all();
}

std::vector<LoadedTile> TileLoader::Impl::take(std::size_t max_bytes) {
  std::vector<LoadedTile> taken;
  std::size_t taken_bytes = 0;
  {
    const std::lock_guard lock(mutex);
    while (!finished.empty()) {
      const std::size_t bytes = weight_bytes(finished.front());
      if (!taken.empty() && taken_bytes + bytes > max_bytes) break;
      taken_bytes += bytes;
      finished_ids.erase(finished.front().id);
      taken.push_back(std::move(finished.front()));
      finished.pop_front();
    }
    finished_bytes -= taken_bytes;
  }
  work_changed.notify_all();
  return taken;
}

void TileLoader::Impl::work() {
  std::unique_lock lock(mutex);
  while (true) {
    work_changed.wait(lock, [this] { return stopping || may_start(); });
    if (stopping) return;
    const TileId id = waiting.back().id;
    waiting.pop_back();
    running.insert(id);
    lock.unlock();
    LoadedTile tile{id, load_without_throwing(id)};
    lock.lock();
    running.erase(id);
    ++read;
    if (!tile.pixels) ++lacked;
    finished_bytes += weight_bytes(tile);
    finished_ids.insert(id);
    finished.push_back(std::move(tile));
    finished_changed.notify_all();
  }
}

Result<TileTexels, TileFailure> TileLoader::Impl::load(const TileId& id) {
  const Result<EncodedTile, TileFailure> encoded = source->read(id);
  if (!encoded) return encoded.error();
  const int tile_px = source->info().grid.tile_px;
  // A tile of another size is refused in any case: a small one after decoding, by name of both sizes, a vast one
  // before.
  DecodeLimits limits;
  limits.max_side_px = std::max(tile_px, 1024);
  const Result<Image> image = decode_image(encoded->bytes, limits);
  if (!image) return TileFailure{Absence::broken, image.error().message};
  return make_texels(*image, tile_px, options.gutter, options.mips);
}

// What leaves a thread as an exception ends the program; memory that ran out for one tile is no reason for that.
Result<TileTexels, TileFailure> TileLoader::Impl::load_without_throwing(const TileId& id) {
  try {
    return load(id);
  } catch (const std::exception& error) {
    return TileFailure{Absence::failed, error.what()};
  }
}

TileLoader::TileLoader(std::shared_ptr<TileSource> source, const LoaderOptions& options)
    : impl_(std::make_unique<Impl>(std::move(source), options)) {
  assert(impl_->source != nullptr);
  assert(options.workers >= 1 && options.workers <= 64);
  assert(options.mips >= 1 && options.mips <= kMaxMips && options.gutter >= 0);
  impl_->start();
}

TileLoader::~TileLoader() { impl_->stop(); }

void TileLoader::request(std::span<const TileRequest> wanted) { impl_->replace_wishes(wanted); }

std::vector<LoadedTile> TileLoader::poll(std::size_t max_bytes) { return impl_->take(max_bytes); }

bool TileLoader::wait(std::chrono::steady_clock::time_point deadline) {
  std::unique_lock lock(impl_->mutex);
  impl_->finished_changed.wait_until(lock, deadline, [this] {
    return !impl_->finished.empty() || (impl_->waiting.empty() && impl_->running.empty());
  });
  return !impl_->finished.empty();
}

LoaderCounts TileLoader::counts() const {
  const std::lock_guard lock(impl_->mutex);
  return {.waiting = impl_->waiting.size(),
          .running = impl_->running.size(),
          .finished = impl_->finished.size(),
          .read = impl_->read,
          .lacked = impl_->lacked};
}

}  // namespace terrella
