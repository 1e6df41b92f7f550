#include "streaming/cache/tile_cache.h"

#include <fmt/format.h>

#include <chrono>
#include <ctime>
#include <mutex>
#include <thread>
#include <utility>

#include "streaming/cache/cache_database.h"
#include "streaming/cache/cache_reader.h"
#include "streaming/cache/cache_writer.h"
#include "streaming/cache/write_queue.h"
#include "streaming/sets/directory_source.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;

/// A use is recorded only if the last recorded one is this old.
constexpr std::int64_t kUseGrain_s = 30;
/// After this long without work the log is written back and emptied.
constexpr std::chrono::seconds kIdle{2};

void apply(const Renewal& renewal, CacheRecord& record) {
  record.stored_unix_s = renewal.stored_unix_s;
  record.expires_unix_s = renewal.expires_unix_s;
}

CacheRecord without_bytes(const CacheRecord& record) {
  return {.missing = record.missing,
          .bytes = {},
          .why = record.why,
          .etag = record.etag,
          .last_modified = record.last_modified,
          .stored_unix_s = record.stored_unix_s,
          .expires_unix_s = record.expires_unix_s,
          .pinned = record.pinned};
}

/// Record of a place after the queue is written, if that does not depend on the file.
CacheRecord record_of(const PendingRecord& pending, bool whole) {
  CacheRecord record = whole ? *pending.record : without_bytes(*pending.record);
  if (pending.renewal && record.missing != MissingKind::failed) apply(*pending.renewal, record);
  return record;
}

WriteQueue::Limits limits_of(const CacheOptions& options, const CacheBudget& budget) {
  return {.batch_tiles = std::max<std::size_t>(1, options.batch_tiles),
          .batch_bytes = budget.batch_bytes,
          .queued_bytes = options.max_queued_bytes};
}

class SqliteTileCache : public TileCache {
 public:
  SqliteTileCache(fs::path path, TileSetInfo info, const CacheOptions& options, fs::path aside,
                  std::unique_ptr<CacheWriter> writer)
      : path_(std::move(path)),
        info_(std::move(info)),
        set_aside_(std::move(aside)),
        on_failed_(options.on_failed),
        writer_(std::move(writer)),
        queue_(limits_of(options, writer_->budget())),
        readers_(path_),
        thread_([this] { write_until_closed(); }) {}

  ~SqliteTileCache() override {
    queue_.close();
    thread_.join();
    readers_.close();
    writer_->close();
  }
  SqliteTileCache(const SqliteTileCache&) = delete;
  SqliteTileCache& operator=(const SqliteTileCache&) = delete;

  [[nodiscard]] const TileSetInfo& info() const override { return info_; }
  [[nodiscard]] fs::path set_aside() const override { return set_aside_; }

  [[nodiscard]] Result<std::optional<CacheRecord>> find(const TileId& id) override { return look_up(id, true); }
  [[nodiscard]] Result<std::optional<CacheRecord>> peek(const TileId& id) override { return look_up(id, false); }
  [[nodiscard]] Status peek_column(
      int level, std::int64_t x, std::int64_t first_y, std::int64_t last_y,
      const std::function<void(std::int64_t y, const CacheRecord& record)>& call) override {
    // Asks the queue before the file, as in look_up().
    if (queue_.has_pending_in(level, x, first_y, last_y)) {
      return TileCache::peek_column(level, x, first_y, last_y, call);
    }
    const auto found = readers_.find_column(level, x, first_y, last_y);
    if (!found) return found.error();
    for (const auto& [y, row] : *found) call(y, row.record);
    return Done{};
  }

  void store(const TileId& id, CacheRecord record, std::function<void(const StoreStatus&)> on_durable) override {
    queue_.push({.id = id,
                 .record = std::make_shared<const CacheRecord>(std::move(record)),
                 .renewal = {},
                 .on_durable = std::move(on_durable)});
  }

  void renew(const TileId& id, std::int64_t stored_unix_s, std::optional<std::int64_t> expires_unix_s,
             std::function<void(const StoreStatus&)> on_durable) override {
    queue_.push(
        {.id = id, .record = nullptr, .renewal = {stored_unix_s, expires_unix_s}, .on_durable = std::move(on_durable)});
  }

  void pin(const TileId& first, std::int64_t last_y, bool pinned) override {
    queue_.push({.id = first, .record = nullptr, .renewal = {}, .on_durable = {}, .pin = PinRun{last_y, pinned}});
  }

  [[nodiscard]] Status flush() override {
    Status flushed = queue_.flush();
    const std::lock_guard lock(writing_);
    return flushed ? writer_->check_place() : flushed;
  }

  [[nodiscard]] CacheCounts counts() const override {
    CacheCounts counts{.file_bytes = 0,
                       .stored = writer_->stored(),
                       .evicted = writer_->evicted(),
                       .pins_changed = writer_->pins_changed(),
                       .locked = writer_->locked()};
    for (const char* ending : {"", "-wal"}) {
      std::error_code error;
      const std::uintmax_t size = fs::file_size(path_.string() + ending, error);
      if (!error) counts.file_bytes += size;
    }
    return counts;
  }

 private:
  [[nodiscard]] Result<std::optional<CacheRecord>> look_up(const TileId& id, bool whole) {
    // Asks the queue before the file: a change that leaves the queue meanwhile is in the file by then.
    const std::optional<PendingRecord> pending = queue_.pending(id);
    const CacheRecord* missing =
        pending && pending->record && pending->record->missing ? pending->record.get() : nullptr;
    if (pending && pending->record && missing == nullptr) return std::optional(record_of(*pending, whole));
    Result<std::optional<FoundRecord>> found = readers_.find(id, whole);
    if (!found) return found.error();
    // A queued missing-tile record does not replace a tile.
    if (missing != nullptr && (!*found || (*found)->record.missing)) return std::optional(record_of(*pending, whole));
    if (!*found) return std::optional<CacheRecord>();
    if (whole) note_use(**found);
    CacheRecord& record = (*found)->record;
    if (missing != nullptr && missing->missing != MissingKind::failed) record.expires_unix_s = missing->expires_unix_s;
    if (pending && pending->renewal) apply(*pending->renewal, record);
    return std::optional(std::move(record));
  }

  void note_use(const FoundRecord& found) {
    if (!found.row || !found.used) return;
    const std::int64_t now = std::time(nullptr);
    if (*found.used + kUseGrain_s <= now) queue_.note_use(*found.row, now);
  }

  void write_until_closed() {
    bool tidied = true;
    for (bool last = false; !last;) {
      CacheBatch batch = queue_.take(std::chrono::steady_clock::now() + (tidied ? std::chrono::hours(1) : kIdle));
      last = batch.last;
      if (!batch.changes.empty() || !batch.uses.empty()) {
        write(batch);
        tidied = false;
      } else if (!last) {
        const std::lock_guard lock(writing_);
        writer_->tidy();
        tidied = true;
      }
    }
  }

  [[nodiscard]] Status write_rows(const CacheBatch& batch, std::vector<bool>& no_room) {
    const std::lock_guard lock(writing_);
    Status status = writer_->write(batch, no_room);
    if (!status && on_failed_) std::exchange(on_failed_, {})(status.error());
    return status;
  }

  void write(CacheBatch& batch) {
    std::vector<bool> no_room(batch.changes.size());
    const Status status = write_rows(batch, no_room);
    for (std::size_t i = 0; i < batch.changes.size(); ++i) {
      if (!batch.changes[i].on_durable) continue;
      if (!status) {
        batch.changes[i].on_durable(StoreError{{status.error().message}});
      } else if (no_room[i]) {
        batch.changes[i].on_durable(StoreError{{path_.string() + ": no room under the limit"}, true});
      } else {
        batch.changes[i].on_durable(Done{});
      }
    }
    queue_.finish(batch, status);
  }

  const fs::path path_;
  const TileSetInfo info_;
  const fs::path set_aside_;
  std::function<void(const Error&)> on_failed_;  ///< thread: the writer
  std::mutex writing_;                           ///< guards the use of writer_
  const std::unique_ptr<CacheWriter> writer_;
  WriteQueue queue_;
  CacheReaders readers_;
  std::thread thread_;  ///< last member, because the thread uses all others
};

}  // namespace

Result<std::shared_ptr<TileCache>, CacheOpenError> TileCache::open(const fs::path& path, const TileSetInfo& info,
                                                                   const std::string& source_key,
                                                                   const CacheOptions& options) {
  Result<OpenedCache, CacheOpenError> opened = open_cache_database(path, info, source_key, options.on_locked);
  if (!opened) return opened.error();
  auto writer = CacheWriter::make(std::move(opened->database), path, info.grid.min_level, options.max_bytes);
  if (!writer) return CacheOpenError{cache_error(path, writer.error()), true};
  return std::shared_ptr<TileCache>(
      std::make_shared<SqliteTileCache>(path, info, options, opened->set_aside, *std::move(writer)));
}

}  // namespace terrella
