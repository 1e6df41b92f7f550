#include "streaming/remote/remote_source.h"

#include <fmt/format.h>

#include <ctime>
#include <utility>

#include "streaming/http/reply_queue.h"
#include "streaming/remote/tile_fetcher.h"
#include "streaming/remote/tile_set_time.h"
#include "tiles/request_desk.h"

namespace terrella {
namespace {

using std::chrono::seconds;

constexpr seconds kTileLife{7 * 24 * 3600};
constexpr seconds kMissingLife{24 * 3600};

std::int64_t unix_now_s() { return static_cast<std::int64_t>(std::time(nullptr)); }

using Encoded = Result<EncodedTile, TileFailure>;

Encoded tile_of(CacheRecord&& record) {
  if (record.missing) return TileFailure{*record.missing, std::move(record.why)};
  return EncodedTile{std::move(record.bytes)};
}

class RemoteSource : public TileSource {
 public:
  RemoteSource(RemoteTileSet set, std::shared_ptr<TileCache> cache, const HttpOptions& options, OpenCache open_cache)
      : set_(std::move(set)),
        cache_(std::move(cache)),
        options_(options),
        open_cache_(std::move(open_cache)),
        desk_({.work = [this](const TileWish& wish) { return ask(wish); },
               .moved = [this](const TileWish& wish) { fetcher_.set_priority(wish.number, wish.priority); },
               .ended =
                   [this](const TileWish& wish, bool is_answered) {
                     if (!is_answered) fetcher_.cancel(wish.number);
                   }}),
        replies_([this](HttpReply&& reply) {
          const std::uint64_t wish = reply.id;
          desk_.resume(wish, [this, reply = std::move(reply)](const TileWish& asked) mutable {
            return answer(asked.id, std::move(reply));
          });
        }),
        fetcher_(set_, options, replies_) {}
  ~RemoteSource() override { desk_.close(); }
  RemoteSource(const RemoteSource&) = delete;
  RemoteSource& operator=(const RemoteSource&) = delete;

  [[nodiscard]] const TileSetInfo& info() const override { return set_.info; }
  [[nodiscard]] RemoteTiles* remote() override { return &desk_; }

  [[nodiscard]] Encoded read(const TileId& id) override {
    if (!exists(set_.info.grid, id)) return TileFailure{MissingKind::absent, "outside the tile set"};
    std::optional<CacheRecord> record = cached(id);
    if (record && is_fresh(*record, unix_now_s())) return tile_of(*std::move(record));
    return TileFailure{MissingKind::remote, {}};
  }

  [[nodiscard]] Result<std::unique_ptr<TileSource>> at_time(UtcTime time) override {
    Result<RemoteTileSet> other = terrella::at_time(set_, time);
    if (!other) return other.error();
    auto cache = open_cache_ ? open_cache_(*other) : Result<std::shared_ptr<TileCache>>(nullptr);
    if (!cache) return cache.error();
    return make_remote_source(*std::move(other), *std::move(cache), options_, open_cache_);
  }

 private:
  [[nodiscard]] std::optional<CacheRecord> cached(const TileId& id) {
    if (cache_ == nullptr) return std::nullopt;
    auto found = cache_->find(id);
    return found ? *std::move(found) : std::nullopt;
  }

  // thread: the desk's ------------------------------------------------------------------------------------------------

  std::optional<Encoded> ask(const TileWish& wish) {
    HttpRequest request;
    request.id = wish.number;
    request.priority = wish.priority;
    if (cache_ != nullptr) {
      if (const auto known = cache_->peek(wish.id); known && *known) {
        request.etag = (*known)->etag;
        request.last_modified = (*known)->last_modified;
      }
    }
    fetcher_.fetch(wish.id, std::move(request));
    return std::nullopt;
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
  const HttpOptions options_;
  const OpenCache open_cache_;  ///< for other times; empty: they have no cache
  RequestDesk desk_;
  ReplyQueue replies_;
  TileFetcher fetcher_;  ///< the last member, because it calls the others
};

}  // namespace

std::unique_ptr<TileSource> make_remote_source(RemoteTileSet set, std::shared_ptr<TileCache> cache,
                                               const HttpOptions& options, OpenCache open_cache) {
  return std::make_unique<RemoteSource>(std::move(set), std::move(cache), options, std::move(open_cache));
}

}  // namespace terrella
