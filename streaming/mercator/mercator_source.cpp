#include "streaming/mercator/mercator_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <condition_variable>
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

/// Looks up stored tiles that are available without a request.
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

/// Fetches for many tiles at once what they are made of: each stored tile once, however many wait for it. Its lock is
/// never held while a stored tile is looked for, because the disk may be slow and `main` takes the lock.
class FetchDesk : public std::enable_shared_from_this<FetchDesk> {
 public:
  FetchDesk(RemoteTiles& network, const StoredTiles& stored, const TileGrid& mercator)
      : network_(network), stored_(stored), decoded_(stored.decoded()), mercator_(mercator) {}

  // thread: worker
  void fetch(const TileId& id, double priority, RemoteTiles::Done done) {
    auto wish = std::make_shared<Wish>(MercatorJob(mercator_, id), priority, std::move(done));
    std::unique_lock lock(mutex_);
    wishes_.insert_or_assign(id, wish);
    work_on(lock, id, wish);
  }

  void set_priority(const TileId& id, double priority) {
    const std::lock_guard lock(mutex_);
    const auto wish = wishes_.find(id);
    if (wish == wishes_.end()) return;
    wish->second->priority = priority;
    for (const TileId& stored : wish->second->missing) {
      if (waiting_.contains(stored)) network_.set_priority(stored, priority_of(stored));  // else it has come
    }
  }

  void cancel(const TileId& id) {
    const std::lock_guard lock(mutex_);
    const auto wish = wishes_.extract(id);
    if (!wish.empty()) stop_waiting(id, wish.mapped()->missing);
  }

  /// Waits for the look-ups that run. Nothing is called back any more.
  void close() {
    std::unique_lock lock(mutex_);
    closed_ = true;
    for (const auto& [stored, waiting] : waiting_) network_.cancel(stored);
    waiting_.clear();
    wishes_.clear();
    idle_.wait(lock, [this] { return working_ == 0; });
  }

 private:
  struct Answer {
    TileId stored;
    MercatorJob::Found found;
  };
  struct Wish {
    Wish(MercatorJob its_job, double its_priority, RemoteTiles::Done its_done)
        : job(std::move(its_job)), priority(its_priority), done(std::move(its_done)) {}
    MercatorJob job;  ///< belongs to the thread that works on the wish, without the lock
    double priority;
    RemoteTiles::Done done;
    bool in_work = false;
    std::vector<Answer> answers;  ///< that came and were not worked on yet
    std::vector<TileId> missing;  ///< the stored tiles that it waits for
  };

  /// Goes on with a wish until it is finished, or waits for the network. Only one thread does so at a time.
  void work_on(std::unique_lock<std::mutex>& lock, const TileId& id, const std::shared_ptr<Wish>& wish) {
    if (closed_ || std::exchange(wish->in_work, true)) return;
    ++working_;
    bool finished = false;
    while (is_wanted(id, wish) && !finished) {
      const std::vector<TileId> missing = look(lock, *wish);
      if (!is_wanted(id, wish)) break;
      finished = missing.empty();
      if (finished) {
        stop_waiting(id, wishes_.extract(id).mapped()->missing);
      } else if (wish->answers.empty()) {
        wait_for(lock, id, *wish, missing);
        if (wish->answers.empty()) break;
      }
    }
    wish->in_work = false;
    if (--working_ == 0) idle_.notify_all();
    lock.unlock();
    if (finished) wish->done(wish->job.result(decoded_));
  }

  // Call the functions below with the lock held.

  [[nodiscard]] bool is_wanted(const TileId& id, const std::shared_ptr<Wish>& wish) const {
    const auto found = wishes_.find(id);
    return !closed_ && found != wishes_.end() && found->second == wish;
  }

  /// Settles the answers that came and looks for tiles that are not known. Gives up the lock meanwhile. Other wishes
  /// may have brought a missing tile during the look, so it looks for a second time. Returns what has to be fetched.
  std::vector<TileId> look(std::unique_lock<std::mutex>& lock, Wish& wish) {
    const auto find = [this](const TileId& stored) { return stored_.find(stored); };
    std::vector<TileId> missing;
    std::vector<TileId> came;
    for (int again = 0; again < 2; ++again) {
      const std::vector<Answer> answers = std::exchange(wish.answers, {});
      const std::uint64_t arrivals = arrivals_;
      lock.unlock();
      for (const Answer& answer : answers) wish.job.settle(answer.stored, answer.found);
      for (const TileId& stored : came) wish.job.settle(stored, find(stored));
      wish.job.advance(find);
      missing = wish.job.missing();
      lock.lock();
      came.clear();
      if (arrivals == arrivals_) break;
      std::ranges::copy_if(missing, std::back_inserter(came),
                           [this](const TileId& stored) { return !waiting_.contains(stored); });
      if (came.empty() || closed_) break;
    }
    return missing;
  }

  [[nodiscard]] double priority_of(const TileId& stored) const {
    double most = -std::numeric_limits<double>::infinity();
    for (const TileId& id : waiting_.at(stored)) most = std::max(most, wishes_.at(id)->priority);
    return most;
  }

  /// Gives up the lock while it asks the network.
  void wait_for(std::unique_lock<std::mutex>& lock, const TileId& id, Wish& wish, const std::vector<TileId>& missing) {
    std::vector<TileId> unasked;
    wish.missing = missing;
    for (const TileId& stored : missing) {
      const auto [waiting, is_new] = waiting_.try_emplace(stored);
      if (std::ranges::find(waiting->second, id) == waiting->second.end()) waiting->second.push_back(id);
      is_new ? unasked.push_back(stored) : network_.set_priority(stored, priority_of(stored));
    }
    const double priority = wish.priority;
    lock.unlock();
    for (const TileId& stored : unasked) {
      network_.fetch(stored, priority, [desk = weak_from_this(), stored](Encoded answer) {
        if (const auto self = desk.lock()) self->arrive(stored, std::move(answer));
      });
    }
    lock.lock();
    for (const TileId& stored : unasked) {
      if (!waiting_.contains(stored)) network_.cancel(stored);  // given up meanwhile, or here already
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

  // thread: a thread of the stored tiles' source
  void arrive(const TileId& stored, Encoded&& answer) {
    const MercatorJob::Found found = found_of(std::move(answer));
    std::vector<std::pair<TileId, std::shared_ptr<Wish>>> wishes;
    std::unique_lock lock(mutex_);
    ++arrivals_;
    const auto waiting = waiting_.extract(stored);
    if (waiting.empty()) return;
    for (const TileId& id : waiting.mapped()) {
      const std::shared_ptr<Wish>& wish = wishes_.at(id);
      wish->answers.push_back({stored, found});
      wishes.emplace_back(id, wish);
    }
    for (const auto& [id, wish] : wishes) {
      if (!lock.owns_lock()) lock.lock();
      work_on(lock, id, wish);
    }
  }

  RemoteTiles& network_;
  const StoredTiles& stored_;  ///< valid until close()
  const std::shared_ptr<DecodedTiles> decoded_;
  const TileGrid mercator_;
  std::mutex mutex_;  ///< guards what follows
  std::condition_variable idle_;
  bool closed_ = false;
  int working_ = 0;             ///< threads in work_on()
  std::uint64_t arrivals_ = 0;  ///< counts the answers of the network
  std::unordered_map<TileId, std::shared_ptr<Wish>, TileIdHash> wishes_;
  std::unordered_map<TileId, std::vector<TileId>, TileIdHash> waiting_;  ///< tiles that wait for each stored tile
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
    if (!exists(info_.grid, id)) return TileFailure{MissingKind::absent, "outside the tile set"};
    MercatorJob job(*info_.made_of, id);
    job.advance([this](const TileId& stored) { return stored_.find(stored); });
    if (!job.missing().empty()) return TileFailure{MissingKind::remote, {}};
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
  std::shared_ptr<FetchDesk> desk_;  ///< null: all tiles are available without requests
};

}  // namespace

Result<std::unique_ptr<TileSource>> as_geodetic(std::unique_ptr<TileSource> stored, const std::string& where) {
  TileSetInfo info = stored->info();
  if (info.square) {
    return Error{fmt::format("{}: its tiles are in {}; tiles in EPSG:4326 or EPSG:3857 can be shown", where,
                             info.square->crs.substr(0, 100))};
  }
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
