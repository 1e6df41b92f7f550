#pragma once

#include <atomic>
#include <chrono>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <unordered_map>
#include <vector>

#include "base/result.h"
#include "streaming/cut.h"
#include "streaming/cut/cut_plan.h"
#include "streaming/cut/growing/coarse_canvas.h"
#include "tiles/request_desk.h"

namespace terrella {

/// Tiles of a picture while it is cut into the cache on a thread of its own. Until a tile is cut, coarse levels are
/// made from a small version of the picture (coarse_raster), which the cut's rows replace, unless it has numbers. Finer
/// tiles are `remote` and arrive when the cut comes to them. Afterwards the finished set is read. thread: any
class GrowingCut : public TileSource {
 public:
  /// Starts the cut of one picture into `folder`, which exists. Fails as cut() would before it reads a pixel. Null for
  /// numbers of which no small version can be read soon: their cut is not begun.
  [[nodiscard]] static Result<std::shared_ptr<GrowingCut>> start(CutOptions options,
                                                                 const std::filesystem::path& folder);
  /// Stops the cut. The next one goes on from there.
  ~GrowingCut() override;
  GrowingCut(const GrowingCut&) = delete;
  GrowingCut& operator=(const GrowingCut&) = delete;

  struct State {
    double share = 0.0;            ///< finished share of the rows, [0, 1]
    bool ended = false;            ///< cut, or failed
    std::optional<Error> error{};  ///< reason why the cut failed
  };
  [[nodiscard]] State state() const;
  [[nodiscard]] const std::filesystem::path& picture() const { return options_.images.front(); }

  [[nodiscard]] const TileSetInfo& info() const override { return planned_.info; }
  [[nodiscard]] Result<EncodedTile, TileFailure> read(const TileId& id) override;
  [[nodiscard]] RemoteTiles* remote() override { return &desk_; }
  [[nodiscard]] std::uint64_t edition() const override { return edition_; }
  [[nodiscard]] std::uint64_t edition_of(const TileId& id) const override {
    return id.level <= coarsest_cut_ ? edition_.load() : 0;
  }

 private:
  using Clock = std::chrono::steady_clock;
  using Answer = Result<EncodedTile, TileFailure>;
  struct Stored {
    std::size_t log = 0;  ///< index in logs_
    std::uint64_t offset = 0;
    std::size_t size = 0;
  };

  GrowingCut(CutOptions options, PlannedCut planned);
  [[nodiscard]] EncodedTile coarse_tile(const TileId& id);
  [[nodiscard]] std::optional<Answer> answer(const TileId& id);
  void run(const std::filesystem::path& folder);
  void paint_coarse();
  void watch();
  void renew(bool now);
  void keep(const CutTile& tile);
  void finish(Result<std::shared_ptr<TileSource>> whole);
  /// Reads a tile that is there; nothing if the cut has not come to it, or the finished set replaces its file just now.
  [[nodiscard]] std::optional<Answer> find(const TileId& id) const;

  CutOptions options_;
  const PlannedCut planned_;
  CoarseCanvas canvas_;
  const int coarsest_cut_;  ///< finer tiles are cut before the end, and are not made from the canvas
  std::atomic<bool> stop_ = false;
  std::atomic<std::uint64_t> edition_ = 1;
  std::atomic<double> share_ = 0.0;
  std::atomic<bool> dirty_ = false;  ///< the canvas or a coarse tile has changed since the last edition
  Clock::time_point renewed_{};
  std::unique_ptr<TileSource> coarse_;  ///< tiles of numbers, instead of the canvas

  mutable std::mutex mutex_;  ///< guards the members below
  std::vector<std::filesystem::path> logs_;
  std::unordered_map<TileId, Stored, TileIdHash> stored_;
  std::shared_ptr<TileSource> whole_;
  std::optional<Error> error_;

  RequestDesk desk_;
  std::thread thread_;  ///< last: it uses all others
};

}  // namespace terrella
