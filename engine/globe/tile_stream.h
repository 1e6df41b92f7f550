#pragma once

#include <chrono>
#include <cstddef>
#include <deque>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "globe/globe.h"
#include "tiles/tile_loader.h"
#include "tiles/tile_residency.h"

namespace terrella {

/// Keeps the tiles that failed last, the latest at the end, as Globe::lacking() gives them.
inline void note(std::deque<LackingTile>& missing, LackingTile tile) {
  constexpr std::size_t kMost = 64;
  missing.push_back(std::move(tile));
  if (missing.size() > kMost) missing.pop_front();
}

/// The tiles of one layer on their way from the source into the scene. It requests what a frame wants, hands over what
/// has come, and marks in the residency what is missing and when to retry. Imagery and heights differ only in what is
/// decoded, and in what the layer does with a decoded tile. thread: main
template <class Decoded>
class TileStream {
 public:
  using Clock = TileResidency::Clock;
  /// `residency` must outlive the stream. `retry_after`: from a failure for now to the next request.
  TileStream(Loader<Decoded> loader, TileResidency& residency, LayerId layer, Clock::duration retry_after)
      : loader_(std::move(loader)), residency_(residency), layer_(layer), retry_after_(retry_after) {}

  /// Requests all that the frame wants. `missing` tiles of it count towards has_news().
  void request(std::span<const TileRequest> wanted) {
    wants_ = !wanted.empty();
    loader_.request(wanted);
  }
  void stop() {
    if (std::exchange(wants_, false)) loader_.request({});
  }
  /// Tiles whose time to retry has come are unknown again.
  void retry() { residency_.retry(Clock::now()); }
  /// The next decoded tile; none if nothing else has come. Tiles that failed are marked, and added to `missing`.
  std::optional<Loaded<Decoded>> take(std::deque<LackingTile>& missing) {
    for (;;) {
      std::vector<Loaded<Decoded>> next = loader_.poll(1);
      if (next.empty()) return std::nullopt;
      if (next.front().tile) return std::move(next.front());
      const TileFailure& failure = next.front().tile.error();
      const bool for_now = failure.kind == Absence::failed;
      residency_.set_missing(next.front().id, for_now ? std::optional(Clock::now() + retry_after_) : std::nullopt);
      note(missing, {next.front().id, failure, layer_});
    }
  }
  /// True if a frame would have something to do: a tile has come, a retry is due, or a tile is wanted and not under
  /// way.
  [[nodiscard]] bool has_news() const {
    if (residency_.has_retry(Clock::now())) return true;
    const LoaderCounts counts = loader_.counts();
    return counts.finished > 0 || (wants_ && counts.waiting + counts.running + counts.fetching == 0);
  }
  [[nodiscard]] LoaderCounts counts() const { return loader_.counts(); }

 private:
  Loader<Decoded> loader_;
  TileResidency& residency_;
  LayerId layer_;
  Clock::duration retry_after_;
  bool wants_ = false;  ///< the last request was not empty
};

}  // namespace terrella
