#include "streaming/warp/make_warp_source.h"

#include <utility>

#include "streaming/warp/fetch_desk.h"

namespace terrella {
namespace {

class WarpSource : public TileSource, public RemoteTiles {
 public:
  WarpSource(std::shared_ptr<TilePlanner> planner, std::shared_ptr<const StoredBlocks> blocks, TileSetInfo info)
      : planner_(std::move(planner)), blocks_(std::move(blocks)), info_(std::move(info)) {
    if (RemoteTiles* network = blocks_->network()) {
      desk_ = std::make_shared<FetchDesk>(*network, blocks_, info_.elevation.has_value());
    }
  }
  ~WarpSource() override {
    if (desk_) desk_->close();
  }
  WarpSource(const WarpSource&) = delete;
  WarpSource& operator=(const WarpSource&) = delete;

  [[nodiscard]] const TileSetInfo& info() const override { return info_; }

  [[nodiscard]] Result<EncodedTile, TileFailure> read(const TileId& id) override {
    if (!exists(info_.grid, id)) return TileFailure{MissingKind::absent, "outside the tile set"};
    WarpJob job(blocks_, planner_->plan(id));
    job.advance();
    if (!job.missing().empty()) return TileFailure{MissingKind::remote, {}};
    return job.result(info_.elevation.has_value());
  }

  [[nodiscard]] RemoteTiles* remote() override { return desk_ ? this : nullptr; }

  void fetch(const TileId& id, double priority, Done done) override {
    desk_->fetch(id, WarpJob(blocks_, planner_->plan(id)), priority, std::move(done));
  }
  void set_priority(const TileId& id, double priority) override { desk_->set_priority(id, priority); }
  void cancel(const TileId& id) override { desk_->cancel(id); }

 private:
  const std::shared_ptr<TilePlanner> planner_;
  const std::shared_ptr<const StoredBlocks> blocks_;
  const TileSetInfo info_;
  std::shared_ptr<FetchDesk> desk_;  ///< null: all blocks are available without requests
};

}  // namespace

TilePlanner::TilePlanner(const RasterInfo& raster, const WarpFigure& figure, GroundMap map, const TileGrid& grid,
                         Overviews overviews)
    : raster_(raster),
      figure_(figure),
      frame_{.grid = grid, .levels = warp_levels(raster, map.turn_px(), grid.tile_px, overviews)} {
  idle_.push_back(std::move(map));
}

Result<std::shared_ptr<TilePlanner>> TilePlanner::open(const RasterInfo& raster, const WarpFigure& figure,
                                                       const TileGrid& grid, Overviews overviews) {
  auto map = GroundMap::open(raster, figure);
  if (!map) return map.error();
  return std::shared_ptr<TilePlanner>(new TilePlanner(raster, figure, *std::move(map), grid, overviews));
}

WarpPlan TilePlanner::plan(const TileId& id) {
  std::optional<GroundMap> map;
  {
    const std::lock_guard lock(mutex_);
    if (!idle_.empty()) {
      map = std::move(idle_.back());
      idle_.pop_back();
    }
  }
  if (!map) {
    auto opened = GroundMap::open(raster_, figure_);
    if (!opened) return {.tile_px = frame_.grid.tile_px, .pieces = {}, .lines = {}, .chunks = {}};
    map = *std::move(opened);
  }
  WarpPlan plan = plan_tile(*map, frame_, id);
  const std::lock_guard lock(mutex_);
  idle_.push_back(*std::move(map));
  return plan;
}

std::unique_ptr<TileSource> make_warp_source(std::unique_ptr<RasterSource> raster, std::shared_ptr<TilePlanner> planner,
                                             TileSetInfo info, BlockNames names, std::size_t decoded_bytes) {
  auto blocks =
      std::make_shared<const StoredBlocks>(std::move(raster), planner->frame().levels, std::move(names), decoded_bytes);
  return std::make_unique<WarpSource>(std::move(planner), std::move(blocks), std::move(info));
}

}  // namespace terrella
