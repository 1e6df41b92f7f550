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
using Encoded = Result<EncodedTile, TileFailure>;

struct Arrived {
  TileId id;
  Encoded encoded;
};

/// A NaN would break the order of the list: it comes last.
double rank(double priority) { return priority == priority ? priority : -std::numeric_limits<double>::infinity(); }

/// What a finished tile counts against the bound. One without pixels counts a little, so that they are bounded too.
std::size_t weight_bytes(const LoadedTile& tile) {
  constexpr std::size_t kFailureBytes = 1024;
  return tile.pixels ? size_bytes(*tile.pixels) : kFailureBytes;
}

Encoded read_without_throwing(TileSource& source, const TileId& id) {
  try {
    return source.read(id);
  } catch (const std::exception& error) {
    return TileFailure{Absence::failed, error.what()};
  }
}

}  // namespace

struct TileLoader::Impl : std::enable_shared_from_this<TileLoader::Impl> {
  Impl(std::shared_ptr<TileSource> tile_source, const LoaderOptions& loader_options)
      : source(std::move(tile_source)), options(loader_options) {}

  // thread: main ----------------------------------------------------------------------------------------------------
  void start();
  void stop();
  void replace_wishes(std::span<const TileRequest> wanted);
  [[nodiscard]] std::vector<LoadedTile> take(std::size_t max_bytes);
  [[nodiscard]] bool under_way(const TileId& id) const;

  // thread: worker --------------------------------------------------------------------------------------------------
  void work();
  void look_for(std::unique_lock<std::mutex>& lock, const TileRequest& wish);
  void decode(std::unique_lock<std::mutex>& lock, const Arrived& tile);
  void finish(const TileId& id, Result<TileTexels, TileFailure> pixels);
  [[nodiscard]] Result<TileTexels, TileFailure> texels_of(const Encoded& encoded) const;
  [[nodiscard]] bool may_start() const {
    return !(waiting.empty() && arrived.empty()) && finished_bytes < options.max_finished_bytes;
  }

  // thread: network -------------------------------------------------------------------------------------------------
  void arrive(const TileId& id, Encoded encoded);

  const std::shared_ptr<TileSource> source;
  RemoteTiles* const remote = source->remote();
  const LoaderOptions options;

  mutable std::mutex mutex;  ///< guards all below but `workers`
  std::condition_variable work_changed;
  std::condition_variable finished_changed;
  bool stopping = false;
  std::vector<TileRequest> waiting;  ///< ascending priority: the next one is the last
  TileIdSet running;
  TileIdSet fetching;
  std::deque<Arrived> arrived;
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
  TileIdSet given_up;
  {
    const std::lock_guard lock(mutex);
    stopping = true;
    waiting.clear();
    given_up.swap(fetching);
  }
  for (const TileId& id : given_up) remote->cancel(id);
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
  std::vector<TileId> dropped;
  std::vector<TileRequest> moved;
  {
    const std::lock_guard lock(mutex);
    std::erase_if(arrived, [&](const Arrived& tile) { return !best.contains(tile.id); });
    for (const TileId& id : fetching) {
      const auto wish = best.find(id);
      wish == best.end() ? dropped.push_back(id) : moved.push_back({id, wish->second});
    }
    for (const TileId& id : dropped) fetching.erase(id);
    std::erase_if(wishes, [&](const TileRequest& wish) { return under_way(wish.id); });
    waiting.swap(wishes);
  }
  // Without the lock: the network's thread may be about to take it.
  for (const TileId& id : dropped) remote->cancel(id);
  for (const TileRequest& wish : moved) remote->set_priority(wish.id, wish.priority);
  work_changed.notify_all();
}

bool TileLoader::Impl::under_way(const TileId& id) const {
  return running.contains(id) || fetching.contains(id) || finished_ids.contains(id) ||
         std::ranges::any_of(arrived, [&id](const Arrived& tile) { return tile.id == id; });
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
    // What has come first: it holds memory, and the screen waits for it.
    if (!arrived.empty()) {
      Arrived tile = std::move(arrived.front());
      arrived.pop_front();
      running.insert(tile.id);
      decode(lock, tile);
    } else {
      const TileRequest wish = waiting.back();
      waiting.pop_back();
      running.insert(wish.id);
      look_for(lock, wish);
    }
  }
}

// Reads a tile; what the source does not have here is asked of the network.
void TileLoader::Impl::look_for(std::unique_lock<std::mutex>& lock, const TileRequest& wish) {
  lock.unlock();
  Encoded encoded = read_without_throwing(*source, wish.id);
  const bool is_remote = !encoded && encoded.error().kind == Absence::remote;
  lock.lock();
  if (!is_remote || remote == nullptr) return decode(lock, {wish.id, std::move(encoded)});
  running.erase(wish.id);
  if (stopping) return;
  fetching.insert(wish.id);
  lock.unlock();
  // The answer may come after this loader is gone.
  remote->fetch(wish.id, wish.priority, [loader = weak_from_this(), id = wish.id](Encoded answer) {
    if (const auto self = loader.lock()) self->arrive(id, std::move(answer));
  });
  lock.lock();
}

void TileLoader::Impl::arrive(const TileId& id, Encoded encoded) {
  {
    const std::lock_guard lock(mutex);
    if (fetching.erase(id) == 0) return;
    arrived.push_back({id, std::move(encoded)});
  }
  work_changed.notify_one();
}

void TileLoader::Impl::decode(std::unique_lock<std::mutex>& lock, const Arrived& tile) {
  lock.unlock();
  Result<TileTexels, TileFailure> pixels = texels_of(tile.encoded);
  lock.lock();
  finish(tile.id, std::move(pixels));
}

void TileLoader::Impl::finish(const TileId& id, Result<TileTexels, TileFailure> pixels) {
  LoadedTile tile{id, std::move(pixels)};
  running.erase(id);
  ++read;
  if (!tile.pixels) ++lacked;
  finished_bytes += weight_bytes(tile);
  finished_ids.insert(id);
  finished.push_back(std::move(tile));
  finished_changed.notify_all();
}

// What leaves a thread as an exception ends the program; memory that ran out for one tile is no reason for that.
Result<TileTexels, TileFailure> TileLoader::Impl::texels_of(const Encoded& encoded) const {
  if (!encoded) return encoded.error();
  const int tile_px = source->info().grid.tile_px;
  // A tile of another size is refused in any case: a small one after decoding, by name of both sizes, a vast one
  // before.
  DecodeLimits limits;
  limits.max_side_px = std::max(tile_px, 1024);
  try {
    const Result<Image> image = decode_image(encoded->bytes, limits);
    if (!image) return TileFailure{Absence::broken, image.error().message};
    return make_texels(*image, tile_px, options.gutter, options.mips);
  } catch (const std::exception& error) {
    return TileFailure{Absence::failed, error.what()};
  }
}

TileLoader::TileLoader(std::shared_ptr<TileSource> source, const LoaderOptions& options)
    : impl_(std::make_shared<Impl>(std::move(source), options)) {
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
    return !impl_->finished.empty() ||
           (impl_->waiting.empty() && impl_->running.empty() && impl_->fetching.empty() && impl_->arrived.empty());
  });
  return !impl_->finished.empty();
}

LoaderCounts TileLoader::counts() const {
  const std::lock_guard lock(impl_->mutex);
  return {.waiting = impl_->waiting.size(),
          .running = impl_->running.size() + impl_->arrived.size(),
          .fetching = impl_->fetching.size(),
          .finished = impl_->finished.size(),
          .read = impl_->read,
          .lacked = impl_->lacked};
}

}  // namespace terrella
