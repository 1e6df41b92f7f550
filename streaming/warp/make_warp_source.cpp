#include "streaming/warp/make_warp_source.h"

#include <cmath>
#include <limits>
#include <utility>

#include "streaming/warp/block_fetcher.h"

namespace terrella {
namespace {

class WarpSource : public TileSource {
 public:
  WarpSource(std::shared_ptr<TilePlanner> planner, std::shared_ptr<const StoredBlocks> blocks, TileSetInfo info)
      : planner_(std::move(planner)), blocks_(std::move(blocks)), info_(std::move(info)) {
    if (blocks_->network() == nullptr) return;
    const auto make_job = [plans = planner_, from = blocks_](const TileId& id) { return job_of(*plans, from, id); };
    fetcher_ = std::make_shared<BlockFetcher>(blocks_, make_job, info_.numbers.has_value());
  }
  ~WarpSource() override {
    if (fetcher_) fetcher_->close();
  }
  WarpSource(const WarpSource&) = delete;
  WarpSource& operator=(const WarpSource&) = delete;

  [[nodiscard]] const TileSetInfo& info() const override { return info_; }
  [[nodiscard]] RemoteTiles* remote() override { return fetcher_ ? &fetcher_->tiles() : nullptr; }

  [[nodiscard]] Result<EncodedTile, TileFailure> read(const TileId& id) override {
    if (!exists(info_.grid, id)) return TileFailure{MissingKind::absent, "outside the tile set"};
    auto job = job_of(*planner_, blocks_, id);
    if (!job) return job.error();
    job->advance();
    if (!job->missing().empty()) return TileFailure{MissingKind::remote, {}};
    return job->result(info_.numbers.has_value());
  }

  [[nodiscard]] Result<double, TileFailure> value_at(const Geodetic& place, const Ellipsoid& figure) override {
    const double row_deg = row_latitude_deg(info_.grid, figure, Ellipsoid::normal(place.lat, place.lon));
    const auto pixel = planner_->pixel_at({.lon_deg = place.lon.deg(), .row_deg = row_deg});
    return pixel ? blocks_->value_at(*pixel) : pixel.error();
  }

 private:
  static Result<WarpJob, TileFailure> job_of(TilePlanner& planner, const std::shared_ptr<const StoredBlocks>& blocks,
                                             const TileId& id) {
    auto plan = planner.plan(id);
    if (!plan) return plan.error();
    return WarpJob(blocks, *std::move(plan));
  }

  const std::shared_ptr<TilePlanner> planner_;
  const std::shared_ptr<const StoredBlocks> blocks_;
  const TileSetInfo info_;
  std::shared_ptr<BlockFetcher> fetcher_;  ///< null: all blocks are available without requests
};

}  // namespace

TilePlanner::TilePlanner(const RasterInfo& raster, const WarpFigure& figure, GroundMap map, const TileGrid& grid,
                         Overviews overviews, Detail detail)
    : raster_(raster),
      figure_(figure),
      frame_{.grid = grid, .levels = warp_levels(raster, map.turn_px(), grid.tile_px, overviews), .detail = detail} {
  idle_.push_back(std::move(map));
}

Result<std::shared_ptr<TilePlanner>> TilePlanner::open(const RasterInfo& raster, const WarpFigure& figure,
                                                       const TileGrid& grid, Overviews overviews, Detail detail) {
  auto map = GroundMap::open(raster, figure);
  if (!map) return map.error();
  return std::shared_ptr<TilePlanner>(new TilePlanner(raster, figure, *std::move(map), grid, overviews, detail));
}

Result<GroundMap, TileFailure> TilePlanner::take_map() {
  {
    const std::lock_guard lock(mutex_);
    if (!idle_.empty()) {
      GroundMap map = std::move(idle_.back());
      idle_.pop_back();
      return map;
    }
  }
  auto opened = GroundMap::open(raster_, figure_);
  if (!opened) return TileFailure{MissingKind::failed, opened.error().message};
  return *std::move(opened);
}

void TilePlanner::put_back(GroundMap map) {
  const std::lock_guard lock(mutex_);
  idle_.push_back(std::move(map));
}

Result<WarpPlan, TileFailure> TilePlanner::plan(const TileId& id) {
  auto map = take_map();
  if (!map) return map.error();
  WarpPlan plan = plan_tile(*map, frame_, id);
  put_back(*std::move(map));
  return plan;
}

Result<CrsPoint, TileFailure> TilePlanner::pixel_at(const RowPlace& place) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  auto map = take_map();
  if (!map) return map.error();
  CrsPoint pixel{kNone, kNone};
  map->pixels(std::span(&place, 1), std::span(&pixel, 1));
  // The turn runs along the rows of every raster that has one and is stored north up.
  if (const auto turn = map->turn_px(); turn && turn->y == 0.0 && turn->x != 0.0) {
    const double turns = std::floor(pixel.x / std::abs(turn->x));
    if (std::isfinite(turns)) pixel.x -= turns * std::abs(turn->x);
  }
  put_back(*std::move(map));
  return pixel;
}

std::unique_ptr<TileSource> make_warp_source(std::unique_ptr<RasterSource> raster, std::shared_ptr<TilePlanner> planner,
                                             TileSetInfo info, BlockNames names, std::size_t decoded_bytes) {
  auto blocks =
      std::make_shared<const StoredBlocks>(std::move(raster), planner->frame().levels, std::move(names), decoded_bytes);
  return std::make_unique<WarpSource>(std::move(planner), std::move(blocks), std::move(info));
}

}  // namespace terrella
