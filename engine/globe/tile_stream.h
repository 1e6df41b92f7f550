#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "globe/globe.h"
#include "tiles/tile_loader.h"
#include "tiles/tile_residency.h"

namespace terrella {

/// Appends a failed tile to a list of the latest failures, for Globe::missing_tiles().
inline void note(std::deque<MissingTile>& missing, MissingTile tile) {
  constexpr std::size_t kMost = 64;
  missing.push_back(std::move(tile));
  if (missing.size() > kMost) missing.pop_front();
}

/// Counts of a stream. A view remembers those of its last frame, and knows by them if others took tiles that it wants.
struct StreamCounts {
  std::uint64_t taken = 0;    ///< tiles handed over, failed ones too
  std::uint64_t retries = 0;  ///< rounds of retries
};

/// Brings the tiles of one layer from the source into the scene. Requests the tiles that a frame wants and hands over
/// arrived tiles. Marks in the residency which tiles are missing and when to retry them. Imagery and heights differ
/// only in the decoded tile and its use. thread: main
template <class Decoded>
class TileStream {
 public:
  using Clock = TileResidency::Clock;
  /// `residency` must outlive the stream. `retry_after` is the time from a temporary failure to the next request.
  TileStream(Loader<Decoded> loader, TileResidency& residency, LayerId layer, Clock::duration retry_after)
      : loader_(std::move(loader)), residency_(residency), layer_(layer), retry_after_(retry_after) {}

  /// Requests all tiles that the frame wants, in place of the previous request.
  void request(std::span<const TileRequest> wanted) {
    wants_ = !wanted.empty();
    loader_.request(wanted);
  }
  /// See Loader::reread().
  void reread(const TileId& id) { loader_.reread(id); }
  void stop() {
    if (std::exchange(wants_, false)) loader_.request({});
  }
  /// Marks tiles as unknown again when their time to retry has come.
  void retry() {
    if (!residency_.has_retry(Clock::now())) return;
    residency_.retry(Clock::now());
    ++taken_.retries;
  }
  /// Returns the next decoded tile; none if no other tile has arrived. Marks failed tiles and appends them to
  /// `missing`.
  std::optional<Loaded<Decoded>> take(std::deque<MissingTile>& missing) {
    for (;;) {
      std::vector<Loaded<Decoded>> next = loader_.poll(1);
      if (next.empty()) return std::nullopt;
      ++taken_.taken;
      if (next.front().tile) return std::move(next.front());
      if (keep_earlier(next.front())) continue;
      const TileFailure& failure = next.front().tile.error();
      const bool for_now = failure.kind == MissingKind::failed;
      residency_.set_missing(next.front().id, for_now ? std::optional(Clock::now() + retry_after_) : std::nullopt);
      note(missing, {next.front().id, failure, layer_});
    }
  }
  [[nodiscard]] const StreamCounts& taken() const { return taken_; }
  /// True if a frame of a view would have something to do: a retry is due or was made since the view's last frame; or
  /// the view wants tiles, and tiles have arrived since then, or none is in flight.
  [[nodiscard]] bool has_news(const StreamCounts& since, bool wants) const {
    if (taken_.retries != since.retries || residency_.has_retry(Clock::now())) return true;
    if (!wants) return false;
    const LoaderCounts counts = loader_.counts();
    return taken_.taken != since.taken || counts.finished > 0 || counts.waiting + counts.running + counts.fetching == 0;
  }
  [[nodiscard]] LoaderCounts counts() const { return loader_.counts(); }

 private:
  /// True if an earlier edition of a failed tile is there. It stays.
  bool keep_earlier(const Loaded<Decoded>& failed) {
    TileResidency::Entry* entry = residency_.find(failed.id);
    if (entry == nullptr || entry->state != TileState::resident) return false;
    entry->edition = failed.edition;
    entry->is_outdated = false;
    return true;
  }

  Loader<Decoded> loader_;
  TileResidency& residency_;
  LayerId layer_;
  Clock::duration retry_after_;
  bool wants_ = false;  ///< the last request was not empty
  StreamCounts taken_;
};

}  // namespace terrella
