#include "streaming/preload/preloader.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <thread>
#include <utility>
#include <vector>

#include "streaming/preload/store_tally.h"
#include "streaming/preload/wanted_tiles.h"

namespace terrella {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr milliseconds kBetweenReports{100};
constexpr milliseconds kLongestWait{5};
constexpr std::size_t kAnswersAtATime = 32;
constexpr int kTilesAtATime = 4096;  // or runs of them
constexpr const char* kNoRoom = "the cache is full of tiles that are not to be evicted";

class Run {
 public:
  Run(const TilePlan& plan, TileCache& cache,
      const std::function<std::unique_ptr<TileOrigin>(ReplyQueue&)>& make_origin, const PreloadOptions& options)
      : plan_(plan),
        cache_(cache),
        options_(options),
        wanted_(plan, cache, options.refresh_older_than),
        tally_(std::make_shared<StoreTally>(options.on_stored)),
        origin_(make_origin(answers_)) {
    counts_.planned = plan.total();
  }

  Result<PreloadResult> run() {
    // Pins before the lookup, so that nothing evicts the found tiles.
    if (const auto pinned = pin_planned(plan_, cache_, true); !pinned) return pinned.error();
    if (const Status passed = first_pass(); !passed) return passed.error();
    if (end_ == PreloadEnd::complete) second_pass();
    wind_down();
    for (const auto& [asked, why] : failed_) note_missing(asked.id, PreloadMissing::failed, why);
    last_asked_ = origin_->counts();
    origin_.reset();
    if (const Status flushed = cache_.flush(); !flushed && !tally_->failed()) return flushed.error();
    while (!tally_->settled()) std::this_thread::sleep_for(kLongestWait);
    note_tiles_without_room();
    if (tally_->failed()) return tally_->error();
    if (options_.progress) options_.progress(counts());
    return PreloadResult{end_, counts()};
  }

 private:
  struct Asked {
    TileId id;
    bool have = false;
  };

  Status first_pass() {
    while (going()) {
      const bool open = is_open();
      for (int n = 0; n < kTilesAtATime && has_window() && !wanted_.done(); ++n) {
        auto next = wanted_.next();
        if (!next) return next.error();
        if (!*next) break;
        open ? ask(**std::move(next)) : put_off_.push_back(**std::move(next));
      }
      if (asked_.empty() && put_off_.empty() && wanted_.done()) return Done{};
      const bool looking = !wanted_.done() && has_window();
      take_answers(looking ? milliseconds(0) : longest_wait(open));
    }
    return Done{};
  }

  // The fetcher has already tried each request several times. This pass helps against faults that last minutes.
  void second_pass() {
    second_ = true;
    std::vector<std::pair<Asked, std::string>> again = std::exchange(failed_, {});
    std::size_t next = 0;
    while (going() && (next < again.size() || !asked_.empty() || !put_off_.empty())) {
      const bool open = is_open();
      for (; open && asked_.size() < options_.window && next < again.size(); ++next) {
        const Asked& asked = again[next].first;
        ask({.id = asked.id, .have = asked.have, .etag = {}, .last_modified = {}});
      }
      take_answers(longest_wait(open));
    }
    failed_.insert(failed_.end(), std::make_move_iterator(again.begin() + static_cast<std::ptrdiff_t>(next)),
                   std::make_move_iterator(again.end()));
  }

  /// True if requests may be sent. Otherwise takes back those that wait to be sent, and asks again later.
  bool is_open() {
    closed_ = options_.closed_for ? options_.closed_for() : std::chrono::seconds(0);
    if (closed_.count() > 0) {
      withdraw_waiting();
      return false;
    }
    for (WantedTileRecord& wanted : std::exchange(put_off_, {})) ask(std::move(wanted));
    return true;
  }
  [[nodiscard]] bool has_window() const { return asked_.size() + put_off_.size() < options_.window; }

  [[nodiscard]] milliseconds longest_wait(bool open) const { return open ? kLongestWait : kBetweenReports; }

  /// Withdraws requests not sent yet, which are the newest.
  void withdraw_waiting() {
    for (std::size_t waiting = origin_->counts().waiting; waiting > 0 && !asked_.empty(); --waiting) {
      const auto latest = std::prev(asked_.end());
      origin_->withdraw(latest->first);
      put_off_.push_back(std::move(latest->second));
      asked_.erase(latest);
    }
  }

  /// Reports progress from time to time. Returns false if the run must stop.
  bool going() {
    if (tally_->failed()) end_ = PreloadEnd::stopped;
    const auto now = Clock::now();
    if (options_.progress && now - reported_ >= kBetweenReports) {
      reported_ = now;
      if (!options_.progress(counts())) end_ = PreloadEnd::stopped;
    }
    if (failures_in_a_row_ >= options_.give_up_after) end_ = PreloadEnd::source_down;
    return end_ == PreloadEnd::complete;
  }

  void ask(WantedTileRecord wanted) {
    if (tally_->out_of_room() && !wanted.have) return note_missing(wanted.id, PreloadMissing::no_room, kNoRoom);
    const std::uint64_t number = ++last_number_;
    origin_->ask({number, wanted.id, wanted.etag, wanted.last_modified});
    asked_.emplace(number, std::move(wanted));
  }

  void note_tiles_without_room() {
    for (const TileId& id : tally_->take_without_room()) note_missing(id, PreloadMissing::no_room, kNoRoom);
  }

  void take_answers(milliseconds longest) {
    note_tiles_without_room();
    for (HttpReply& reply : answers_.take_all(longest)) {
      const auto asked = asked_.find(reply.id);
      if (asked == asked_.end()) continue;
      const Asked about{asked->second.id, asked->second.have};
      asked_.erase(asked);
      failures_in_a_row_ = reply.outcome == HttpOutcome::failed ? failures_in_a_row_ + 1 : 0;
      settle(about, std::move(reply));
    }
  }

  void settle(const Asked& asked, HttpReply&& reply) {
    switch (reply.outcome) {
      case HttpOutcome::content:
        return settle_content(asked, std::move(reply));
      case HttpOutcome::not_modified:
        if (!asked.have)
          return note_missing(asked.id, PreloadMissing::broken,
                              "304 Not Modified of what was never asked for conditionally");
        return cache_.renew(asked.id, unix_now_s(), expiry(reply, options_.tile_life),
                            tally_->sent(StoreTally::Kind::unchanged, asked.id, 0));
      case HttpOutcome::nothing:
        return note_missing(asked, MissingKind::absent, std::move(reply));
      case HttpOutcome::refused:
        return note_missing(asked.id, PreloadMissing::refused, reply.why);
      case HttpOutcome::broken:
        return note_missing(asked.id, PreloadMissing::broken, reply.why);
      case HttpOutcome::failed:
        if (second_ || failed_.size() >= options_.most_second_tries)
          return note_missing(asked.id, PreloadMissing::failed, reply.why);
        failed_.emplace_back(asked, std::move(reply.why));
    }
  }

  void settle_content(const Asked& asked, HttpReply&& reply) {
    const TileId& id = asked.id;
    if (reply.no_store)
      return note_missing(id, PreloadMissing::refused, "the server forbids storing it (Cache-Control: no-store)");
    if (reply.body.empty()) return note_missing(asked, MissingKind::blank, std::move(reply));
    const std::size_t bytes = reply.body.size();
    CacheRecord record = record_of(std::move(reply), options_.tile_life);
    record.pinned = true;
    cache_.store(id, std::move(record), tally_->sent(StoreTally::Kind::tile, id, bytes));
  }

  // The cache keeps a stored tile.
  void note_missing(const Asked& asked, MissingKind kind, HttpReply&& reply) {
    reply.body.clear();
    std::string why = std::move(reply.why);
    CacheRecord record = record_of(std::move(reply), options_.missing_life);
    record.missing = kind;
    record.why = std::move(why);
    auto counted = kind == MissingKind::blank ? StoreTally::Kind::blank : StoreTally::Kind::absent;
    if (asked.have) counted = StoreTally::Kind::kept;
    cache_.store(asked.id, std::move(record), tally_->sent(counted, asked.id, 0));
  }

  [[nodiscard]] CacheRecord record_of(HttpReply&& reply, std::chrono::seconds life) const {
    CacheRecord record;
    record.bytes = std::move(reply.body);
    record.etag = std::move(reply.etag);
    record.last_modified = std::move(reply.last_modified);
    record.stored_unix_s = unix_now_s();
    record.expires_unix_s = expiry(reply, life);
    return record;
  }

  [[nodiscard]] std::optional<std::int64_t> expiry(const HttpReply& reply, std::chrono::seconds life) const {
    if (!options_.expires) return std::nullopt;
    return reply.expires_unix_s ? *reply.expires_unix_s : unix_now_s() + life.count();
  }

  void note_missing(const TileId& id, PreloadMissing kind, const std::string& why) {
    if (kind == PreloadMissing::broken) ++counts_.broken;
    if (kind == PreloadMissing::refused) ++counts_.refused;
    if (kind == PreloadMissing::failed) ++counts_.failed;
    if (kind == PreloadMissing::no_room) ++counts_.no_room;
    if (options_.on_missing) options_.on_missing(id, kind, why);
  }

  // Waits for answers that the host has begun.
  void wind_down() {
    closed_ = std::chrono::seconds(0);
    withdraw_waiting();
    const auto deadline = Clock::now() + options_.finish_within;
    while (!asked_.empty() && Clock::now() < deadline && !tally_->failed()) take_answers(kLongestWait);
  }

  [[nodiscard]] PreloadCounts counts() const {
    PreloadCounts counts = counts_;
    counts.there = wanted_.there();
    counts.stored = tally_->durable(StoreTally::Kind::tile);
    counts.unchanged = tally_->durable(StoreTally::Kind::unchanged);
    counts.absent = tally_->durable(StoreTally::Kind::absent);
    counts.blank = tally_->durable(StoreTally::Kind::blank);
    counts.kept = tally_->durable(StoreTally::Kind::kept);
    if (second_ || !put_off_.empty()) counts.waits = closed_;
    counts.locked = cache_.counts().locked;
    counts.stored_bytes = tally_->bytes();
    counts.passed =
        counts.there + counts.stored + counts.unchanged + counts.absent + counts.blank + counts.kept + counts.missing();
    if (origin_) last_asked_ = origin_->counts();
    counts.asked = last_asked_;
    return counts;
  }

  const TilePlan& plan_;
  TileCache& cache_;
  const PreloadOptions& options_;
  WantedTiles wanted_;
  std::shared_ptr<StoreTally> tally_;
  ReplyQueue answers_{kAnswersAtATime};
  std::map<std::uint64_t, WantedTileRecord> asked_;  ///< by number: in the order of asking
  std::vector<WantedTileRecord> put_off_;            ///< wait until requests may be sent
  std::chrono::seconds closed_{0};                   ///< time until then
  std::vector<std::pair<Asked, std::string>> failed_;
  PreloadCounts counts_;
  mutable HttpCounts last_asked_;
  std::uint64_t last_number_ = 0;
  int failures_in_a_row_ = 0;
  bool second_ = false;
  PreloadEnd end_ = PreloadEnd::complete;
  Clock::time_point reported_{};
  std::unique_ptr<TileOrigin> origin_;  ///< destroyed first, because it calls back into the other members
};

}  // namespace

Result<std::int64_t> pin_planned(const TilePlan& plan, TileCache& cache, bool pinned) {
  const std::uint64_t before = cache.counts().pins_changed;
  const auto feed = plan.walk();
  auto run = feed->next();
  while (run) {
    for (int n = 0; run && n < kTilesAtATime; ++n, run = feed->next()) {
      cache.pin({run->level, run->x, run->first_y}, run->last_y, pinned);
    }
    if (const Status flushed = cache.flush(); !flushed) return flushed.error();
  }
  return static_cast<std::int64_t>(cache.counts().pins_changed - before);
}

Result<PreloadResult> preload(const TilePlan& plan, TileCache& cache,
                              const std::function<std::unique_ptr<TileOrigin>(ReplyQueue&)>& make_origin,
                              const PreloadOptions& options) {
  constexpr std::size_t kMostWindow = 100'000;
  if (options.window < 1 || options.window > kMostWindow) {
    return Error{fmt::format("preload: a window of {} requests; give 1 to {}", options.window, kMostWindow)};
  }
  return Run(plan, cache, make_origin, options).run();
}

}  // namespace terrella
