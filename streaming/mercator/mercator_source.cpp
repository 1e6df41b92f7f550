#include "streaming/mercator/mercator_source.h"

#include <algorithm>
#include <limits>
#include <mutex>
#include <unordered_map>
#include <utility>
#include <vector>

#include "streaming/mercator/mercator_job.h"
#include "streaming/sets/tileset_check.h"

namespace terrella {
namespace {

using Encoded = Result<EncodedTile, TileFailure>;

MercatorJob::Found found_of(Encoded&& answer) {
  if (!answer) return {.bytes = nullptr, .picture = nullptr, .failure = answer.error()};
  return {.bytes = std::make_shared<const std::vector<std::byte>>(std::move(answer->bytes)),
          .picture = nullptr,
          .failure = {}};
}

/// Looks for stored tiles where they are at hand.
class StoredTiles {
 public:
  explicit StoredTiles(TileSource& source) : source_(source) {}

  [[nodiscard]] MercatorJob::Found find(const TileId& id) const {
    if (auto picture = decoded_->find(id)) return {.bytes = nullptr, .picture = std::move(picture), .failure = {}};
    return found_of(source_.read(id));
  }
  [[nodiscard]] const std::shared_ptr<DecodedTiles>& decoded() const { return decoded_; }

 private:
  TileSource& source_;
  const std::shared_ptr<DecodedTiles> decoded_ = std::make_shared<DecodedTiles>(kMercatorDecodedBytes);
};

/// Fetches for many tiles at once what they are made of: each stored tile once, however many wait for it. Its lock may
/// be held while the stored tiles' network is called, which calls back from its own thread without locks.
class FetchDesk : public std::enable_shared_from_this<FetchDesk> {
 public:
  FetchDesk(RemoteTiles& network, const StoredTiles& stored, const TileGrid& mercator)
      : network_(network), stored_(stored), decoded_(stored.decoded()), mercator_(mercator) {}

  void fetch(const TileId& id, double priority, RemoteTiles::Done done) {
    auto wish = std::make_shared<Wish>(Wish{MercatorJob(mercator_, id), priority, std::move(done)});
    wish->job.advance(look_up());
    {
      const std::lock_guard lock(mutex_);
      settle_what_came(wish->job);
      const std::vector<TileId> missing = wish->job.missing();
      if (!missing.empty()) {
        wishes_.insert_or_assign(id, wish);
        wait_for(id, missing, priority);
        return;
      }
    }
    // Another tile brought meanwhile what this one was made of.
    wish->done(wish->job.result(decoded_));
  }

  void set_priority(const TileId& id, double priority) {
    const std::lock_guard lock(mutex_);
    const auto wish = wishes_.find(id);
    if (wish == wishes_.end()) return;
    wish->second->priority = priority;
    for (const TileId& stored : wish->second->job.missing()) network_.set_priority(stored, priority_of(stored));
  }

  void cancel(const TileId& id) {
    const std::lock_guard lock(mutex_);
    const auto wish = wishes_.extract(id);
    if (!wish.empty()) stop_waiting(id, wish.mapped()->job.missing());
  }

  /// Nothing is called back any more.
  void close() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    for (const auto& [stored, waiting] : waiting_) network_.cancel(stored);
    waiting_.clear();
    wishes_.clear();
  }

 private:
  struct Wish {
    MercatorJob job;
    double priority;
    RemoteTiles::Done done;
  };

  [[nodiscard]] MercatorJob::LookUp look_up() const {
    return [this](const TileId& stored) { return stored_.find(stored); };
  }

  // With the lock.

  /// What was on its way when the job looked for it, and nobody waits for any more, may have come.
  void settle_what_came(MercatorJob& job) const {
    for (const TileId& stored : job.missing()) {
      if (!waiting_.contains(stored)) job.settle(stored, stored_.find(stored));
    }
    job.advance(look_up());
  }

  [[nodiscard]] double priority_of(const TileId& stored) const {
    double most = -std::numeric_limits<double>::infinity();
    for (const TileId& id : waiting_.at(stored)) most = std::max(most, wishes_.at(id)->priority);
    return most;
  }

  void wait_for(const TileId& id, const std::vector<TileId>& missing, double priority) {
    for (const TileId& stored : missing) {
      const auto [waiting, is_new] = waiting_.try_emplace(stored);
      if (std::ranges::find(waiting->second, id) == waiting->second.end()) waiting->second.push_back(id);
      if (!is_new) {
        network_.set_priority(stored, priority_of(stored));
        continue;
      }
      network_.fetch(stored, priority, [desk = weak_from_this(), stored](Encoded answer) {
        if (const auto self = desk.lock()) self->arrive(stored, std::move(answer));
      });
    }
  }

  void stop_waiting(const TileId& id, const std::vector<TileId>& missing) {
    for (const TileId& stored : missing) {
      const auto waiting = waiting_.find(stored);
      if (waiting == waiting_.end()) continue;
      std::erase(waiting->second, id);
      if (!waiting->second.empty()) continue;
      waiting_.erase(waiting);
      network_.cancel(stored);
    }
  }

  // thread: a thread of the source
  void arrive(const TileId& stored, Encoded&& answer) {
    const MercatorJob::Found found = found_of(std::move(answer));
    std::vector<std::shared_ptr<Wish>> finished;
    {
      const std::lock_guard lock(mutex_);
      if (closed_) return;
      const auto waiting = waiting_.extract(stored);
      if (waiting.empty()) return;
      for (const TileId& id : waiting.mapped()) {
        if (auto wish = settle(id, stored, found)) finished.push_back(std::move(wish));
      }
    }
    for (const auto& wish : finished) wish->done(wish->job.result(decoded_));
  }

  /// The wish if that finished it.
  std::shared_ptr<Wish> settle(const TileId& id, const TileId& stored, const MercatorJob::Found& found) {
    const auto place = wishes_.find(id);
    if (place == wishes_.end()) return nullptr;
    std::shared_ptr<Wish> wish = place->second;
    const std::vector<TileId> before = wish->job.missing();
    wish->job.settle(stored, found);
    wish->job.advance(look_up());
    const std::vector<TileId> after = wish->job.missing();
    if (after.empty()) {
      wishes_.erase(place);
      stop_waiting(id, before);
      return wish;
    }
    std::vector<TileId> further;
    std::ranges::copy_if(after, std::back_inserter(further),
                         [&](const TileId& one) { return std::ranges::find(before, one) == before.end(); });
    wait_for(id, further, wish->priority);
    return nullptr;
  }

  RemoteTiles& network_;
  const StoredTiles& stored_;  ///< until close()
  const std::shared_ptr<DecodedTiles> decoded_;
  const TileGrid mercator_;
  std::mutex mutex_;  ///< guards what follows
  bool closed_ = false;
  std::unordered_map<TileId, std::shared_ptr<Wish>, TileIdHash> wishes_;
  std::unordered_map<TileId, std::vector<TileId>, TileIdHash> waiting_;  ///< of each stored tile, the tiles
};

class MercatorSource : public TileSource, public RemoteTiles {
 public:
  MercatorSource(std::unique_ptr<TileSource> source, TileSetInfo info)
      : source_(std::move(source)), info_(std::move(info)), stored_(*source_) {
    if (RemoteTiles* network = source_->remote()) {
      desk_ = std::make_shared<FetchDesk>(*network, stored_, *info_.made_of);
    }
  }
  ~MercatorSource() override {
    if (desk_) desk_->close();
  }
  MercatorSource(const MercatorSource&) = delete;
  MercatorSource& operator=(const MercatorSource&) = delete;

  [[nodiscard]] const TileSetInfo& info() const override { return info_; }

  [[nodiscard]] Encoded read(const TileId& id) override {
    if (!exists(info_.grid, id)) return TileFailure{Absence::absent, "outside the tile set"};
    MercatorJob job(*info_.made_of, id);
    job.advance([this](const TileId& stored) { return stored_.find(stored); });
    if (!job.missing().empty()) return TileFailure{Absence::remote, {}};
    return job.result(stored_.decoded());
  }

  [[nodiscard]] RemoteTiles* remote() override { return desk_ ? this : nullptr; }

  void fetch(const TileId& id, double priority, Done done) override { desk_->fetch(id, priority, std::move(done)); }
  void set_priority(const TileId& id, double priority) override { desk_->set_priority(id, priority); }
  void cancel(const TileId& id) override { desk_->cancel(id); }

 private:
  const std::unique_ptr<TileSource> source_;
  const TileSetInfo info_;
  const StoredTiles stored_;
  std::shared_ptr<FetchDesk> desk_;  ///< none: all tiles are at hand
};

}  // namespace

Result<std::unique_ptr<TileSource>> as_geodetic(std::unique_ptr<TileSource> stored, const std::string& where) {
  TileSetInfo info = stored->info();
  if (info.grid.projection != Projection::web_mercator) return stored;
  if (info.elevation) {
    return Error{where +
                 ": its tiles are heights in Web Mercator; heights are read from a set in EPSG:4326 (gdalwarp -t_srs "
                 "EPSG:4326, then terrella cut --elevation)"};
  }
  info.made_of = info.grid;
  info.grid = geodetic_grid_of(info.grid);
  if (Status good = check_grid(info.grid, where + ": between the ends of Web Mercator"); !good) return good.error();
  return std::unique_ptr<TileSource>(std::make_unique<MercatorSource>(std::move(stored), std::move(info)));
}

}  // namespace terrella
