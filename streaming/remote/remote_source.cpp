#include "streaming/remote/remote_source.h"

#include <fmt/format.h>

#include <ctime>
#include <mutex>
#include <system_error>
#include <thread>
#include <unordered_map>
#include <utility>
#include <vector>

#include "streaming/http/reply_queue.h"
#include "streaming/remote/tile_fetcher.h"
#include "tiles/late_workers.h"

namespace terrella {
namespace {

using std::chrono::seconds;

constexpr seconds kTileLife{7 * 24 * 3600};
constexpr seconds kMissingLife{24 * 3600};
// Threads that check replies, store them in the cache and answer requests. If one waits for a disk, the other goes on.
constexpr int kAnswerers = 2;

std::int64_t unix_now_s() { return static_cast<std::int64_t>(std::time(nullptr)); }

using Encoded = Result<EncodedTile, TileFailure>;

Encoded tile_of(CacheRecord&& record) {
  if (record.missing) return TileFailure{*record.missing, std::move(record.why)};
  return EncodedTile{std::move(record.bytes)};
}

/// The threads of a source, and the data that they use.
class RemoteDesk : public RemoteTiles {
 public:
  RemoteDesk(RemoteTileSet set, std::shared_ptr<TileCache> cache, const HttpOptions& options)
      : set_(std::move(set)), cache_(std::move(cache)), fetcher_(set_, options, replies_) {
    start_answering();
  }
  ~RemoteDesk() override { replies_.close(); }
  RemoteDesk(const RemoteDesk&) = delete;
  RemoteDesk& operator=(const RemoteDesk&) = delete;

  [[nodiscard]] const TileSetInfo& info() const { return set_.info; }
  [[nodiscard]] const std::vector<std::jthread>& threads() const { return answerers_; }

  [[nodiscard]] Encoded read(const TileId& id) {
    if (!exists(set_.info.grid, id)) return TileFailure{MissingKind::absent, "outside the tile set"};
    std::optional<CacheRecord> record = cached(id);
    if (record && is_fresh(*record, unix_now_s())) return tile_of(*std::move(record));
    return TileFailure{MissingKind::remote, {}};
  }

  void fetch(const TileId& id, double priority, Done done) override {
    HttpRequest request;
    request.priority = priority;
    if (cache_ != nullptr) {
      if (const auto known = cache_->peek(id); known && *known) {
        request.etag = (*known)->etag;
        request.last_modified = (*known)->last_modified;
      }
    }
    {
      const std::lock_guard lock(mutex_);
      request.id = ++last_number_;
      numbers_.insert_or_assign(id, request.id);
      asked_.emplace(request.id, Asked{id, std::move(done)});
    }
    fetcher_.fetch(id, std::move(request));
  }

  void set_priority(const TileId& id, double priority) override {
    if (const std::uint64_t number = number_of(id); number != 0) fetcher_.set_priority(number, priority);
  }

  void cancel(const TileId& id) override {
    const std::uint64_t number = number_of(id);
    if (number == 0) return;
    forget(number);
    fetcher_.cancel(number);
  }

 private:
  struct Asked {
    TileId id;
    Done done;
  };

  [[nodiscard]] std::optional<CacheRecord> cached(const TileId& id) {
    if (cache_ == nullptr) return std::nullopt;
    auto found = cache_->find(id);
    return found ? *std::move(found) : std::nullopt;
  }

  [[nodiscard]] std::uint64_t number_of(const TileId& id) {
    const std::lock_guard lock(mutex_);
    const auto number = numbers_.find(id);
    return number == numbers_.end() ? 0 : number->second;
  }

  std::optional<Asked> forget(std::uint64_t number) {
    const std::lock_guard lock(mutex_);
    auto asked = asked_.extract(number);
    if (asked.empty()) return std::nullopt;
    // Another request for the same tile may have followed.
    const auto latest = numbers_.find(asked.mapped().id);
    if (latest != numbers_.end() && latest->second == number) numbers_.erase(latest);
    return std::move(asked.mapped());
  }

  void start_answering() {
    for (int i = 0; i < kAnswerers; ++i) {
      try {
        answerers_.emplace_back([this] {
          while (auto reply = replies_.take()) settle(*std::move(reply));
        });
      } catch (const std::system_error&) {
        if (answerers_.empty()) throw;
        return;  // the system has no more threads; one suffices
      }
    }
  }

  [[nodiscard]] std::optional<TileId> id_of_request(std::uint64_t number) {
    const std::lock_guard lock(mutex_);
    const auto asked = asked_.find(number);
    return asked == asked_.end() ? std::nullopt : std::optional(asked->second.id);
  }

  // thread: answering
  void settle(HttpReply&& reply) {
    const std::uint64_t number = reply.id;
    const std::optional<TileId> id = id_of_request(number);
    if (!id) return;
    Encoded encoded = answer_or_failure(*id, std::move(reply));
    // The cache may have been slow, and the request may have been cancelled meanwhile.
    if (const std::optional<Asked> asked = forget(number)) asked->done(std::move(encoded));
  }

  /// Catches all exceptions, because an exception that leaves a thread ends the program.
  Encoded answer_or_failure(const TileId& id, HttpReply&& reply) {
    try {
      return answer(id, std::move(reply));
    } catch (const std::exception& error) {
      return TileFailure{MissingKind::failed, error.what()};
    } catch (...) {
      return TileFailure{MissingKind::failed, "unknown exception"};
    }
  }

  Encoded answer(const TileId& id, HttpReply&& reply) {
    switch (reply.outcome) {
      case HttpOutcome::content:
        return content(id, std::move(reply));
      case HttpOutcome::not_modified:
        if (auto record = cached(id)) {
          cache_->renew(id, unix_now_s(), expiry(reply, record->missing ? missing_life() : tile_life()));
          return tile_of(*std::move(record));
        }
        break;
      case HttpOutcome::nothing:
        return missing(id, MissingKind::absent, std::move(reply), missing_life());
      case HttpOutcome::refused:
      case HttpOutcome::failed:
      case HttpOutcome::broken:  // the next run asks again: the server may be well by then
        // An old tile is better than none (stale-if-error, RFC 5861).
        if (auto record = cached(id)) return tile_of(*std::move(record));
        break;
    }
    const bool broken = reply.outcome == HttpOutcome::broken;
    return TileFailure{broken ? MissingKind::broken : MissingKind::failed, std::move(reply.why)};
  }

  Encoded content(const TileId& id, HttpReply&& reply) {
    if (reply.body.empty()) return missing(id, MissingKind::blank, std::move(reply), missing_life());
    EncodedTile tile{reply.body};
    if (cache_ != nullptr && !reply.no_store) cache_->store(id, record_of(std::move(reply), tile_life()));
    return tile;
  }

  Encoded missing(const TileId& id, MissingKind kind, HttpReply&& reply, seconds life) {
    TileFailure failure{kind, reply.why};
    if (cache_ == nullptr) return failure;
    // If the cache has the tile, the cache keeps it (CacheRows::put()) and the picture shows it.
    auto known = cached(id);
    const bool stored = known && !known->missing;
    if (reply.no_store) return stored ? tile_of(*std::move(known)) : Encoded(failure);
    reply.body.clear();
    CacheRecord record = record_of(std::move(reply), life);
    record.missing = kind;
    record.why = failure.why;
    cache_->store(id, std::move(record));
    return stored ? tile_of(*std::move(known)) : Encoded(failure);
  }

  static std::optional<std::int64_t> expiry(const HttpReply& reply, seconds life) {
    return reply.expires_unix_s ? *reply.expires_unix_s : unix_now_s() + life.count();
  }

  static CacheRecord record_of(HttpReply&& reply, seconds life) {
    CacheRecord record;
    record.expires_unix_s = expiry(reply, life);
    record.bytes = std::move(reply.body);
    record.etag = std::move(reply.etag);
    record.last_modified = std::move(reply.last_modified);
    record.stored_unix_s = unix_now_s();
    return record;
  }

  [[nodiscard]] seconds tile_life() const { return set_.tile_life.value_or(kTileLife); }
  [[nodiscard]] seconds missing_life() const { return set_.missing_life.value_or(kMissingLife); }

  const RemoteTileSet set_;
  const std::shared_ptr<TileCache> cache_;
  std::mutex mutex_;  ///< guards the next three members
  std::uint64_t last_number_ = 0;
  std::unordered_map<std::uint64_t, Asked> asked_;
  std::unordered_map<TileId, std::uint64_t, TileIdHash> numbers_;  ///< number of the latest request for each tile
  ReplyQueue replies_;
  TileFetcher fetcher_;
  std::vector<std::jthread> answerers_;  ///< the last member, because the threads use the others
};

class RemoteSource : public TileSource {
 public:
  explicit RemoteSource(std::unique_ptr<RemoteDesk> desk) : desk_(std::move(desk)) {}
  ~RemoteSource() override { end_owner(std::move(desk_)); }
  RemoteSource(const RemoteSource&) = delete;
  RemoteSource& operator=(const RemoteSource&) = delete;

  [[nodiscard]] const TileSetInfo& info() const override { return desk_->info(); }
  [[nodiscard]] Encoded read(const TileId& id) override { return desk_->read(id); }
  [[nodiscard]] RemoteTiles* remote() override { return desk_.get(); }

 private:
  std::unique_ptr<RemoteDesk> desk_;
};

}  // namespace

std::unique_ptr<TileSource> make_remote_source(RemoteTileSet set, std::shared_ptr<TileCache> cache,
                                               const HttpOptions& options) {
  return std::make_unique<RemoteSource>(std::make_unique<RemoteDesk>(std::move(set), std::move(cache), options));
}

}  // namespace terrella
