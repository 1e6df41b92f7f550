#include "streaming/warp/warp_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "streaming/warp/block_fetcher.h"
#include "streaming/warp/map/raster_extent.h"
#include "tiles/grid_ranges.h"

namespace terrella {
namespace {

/// An edge this close to a pixel's of the grid lies on it, pixels.
constexpr double kOnGrid_px = 1e-3;

Status check_raster(const RasterInfo& raster, const std::string& where) {
  if (raster.levels.empty()) return Error{where + ": has no pixels"};
  for (const RasterLevel& level : raster.levels) {
    if (level.width_px < 1 || level.height_px < 1 || level.block_width_px < 1 || level.block_height_px < 1) {
      return Error{fmt::format("{}: a level of {}×{} pixels in blocks of {}×{} has no pixels", where, level.width_px,
                               level.height_px, level.block_width_px, level.block_height_px)};
    }
    if (!level.to_crs.is_finite()) {
      return Error{where +
                   ": its transform from pixels to coordinates is not finite, or flattens all pixels to a line"};
    }
  }
  return Done{};
}

/// The size of the grid's finest pixels: the raster's, or a little less, a whole fraction of 360°.
double pixel_size_deg(double pixels_per_deg) {
  const double columns = 360.0 * pixels_per_deg;
  const double whole =
      std::abs(columns - std::round(columns)) < 1e-6 * columns ? std::round(columns) : std::ceil(columns);
  return 360.0 / std::max(whole, 1.0);
}

/// Moves an edge outward to the edge of a pixel of the grid, counted from `origin`.
double to_grid(double deg, double origin_deg, double pixel_deg, bool up) {
  const double at = (deg - origin_deg) / pixel_deg;
  const double near = std::round(at);
  if (std::abs(at - near) < kOnGrid_px) return origin_deg + near * pixel_deg;
  return origin_deg + (up ? std::ceil(at) : std::floor(at)) * pixel_deg;
}

GeoRect bounds_of(const RasterExtent& extent, double pixel_deg) {
  double west = to_grid(extent.west_deg, -180.0, pixel_deg, false);
  double east = to_grid(extent.east_deg, -180.0, pixel_deg, true);
  if (east - west > 360.0 - 0.5 * pixel_deg) {
    west = -180.0;
    east = 180.0;
  }
  const auto in_turn = [](double lon) { return lon > 180.0 ? lon - 360.0 : lon; };
  const double south = to_grid(extent.south_deg, 90.0, pixel_deg, false);
  const double north = to_grid(extent.north_deg, 90.0, pixel_deg, true);
  return {.west = Angle::degrees(std::max(in_turn(west), -180.0)),
          .south = Angle::degrees(std::max(south, -90.0)),
          .east = Angle::degrees(in_turn(east)),
          .north = Angle::degrees(std::min(north, 90.0))};
}

Result<TileGrid> grid_for(const GroundMap& map, const RasterInfo& raster, const WarpOptions& options,
                          const std::string& where) {
  const RasterLevel& finest = raster.levels.back();
  const auto width = static_cast<double>(finest.width_px), height = static_cast<double>(finest.height_px);
  const auto extent = raster_extent(map, width, height);
  const auto per_degree = pixels_per_degree(map, width, height);
  if (!extent || !per_degree) {
    return Error{where +
                 ": none of its pixels has a place on the planet; its transform or its coordinate system is "
                 "wrong (gdalinfo shows both)"};
  }
  const double pixel_deg = pixel_size_deg(std::max(*per_degree, options.tile_px / kMaxRootSpanDeg));
  int level = 0;
  while (std::ldexp(pixel_deg * options.tile_px, level) < 180.0 * (1.0 - 1e-9)) ++level;
  if (level > kMaxTileLevel) {
    return Error{
        fmt::format("{}: its pixels of {:.3g} degrees need {} levels, more than {}; its transform is wrong, or "
                    "it takes a larger tile size",
                    where, pixel_deg, level + 1, kMaxTileLevel + 1)};
  }
  TileGrid grid{.root_span_deg = std::ldexp(pixel_deg * options.tile_px, level),
                .tile_px = options.tile_px,
                .max_level = level,
                .latitude = options.figure.latitude,
                .bounds = bounds_of(*extent, pixel_deg)};
  if (Status good = check_grid(grid, where); !good) return good.error();
  return grid;
}

class WarpSource : public TileSource {
 public:
  WarpSource(std::shared_ptr<TilePlanner> planner, std::shared_ptr<const StoredBlocks> blocks, TileSetInfo info,
             SourceAtTime at_time)
      : planner_(std::move(planner)), blocks_(std::move(blocks)), info_(std::move(info)), at_time_(std::move(at_time)) {
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

  [[nodiscard]] Result<std::unique_ptr<TileSource>> at_time(UtcTime time) override {
    return at_time_ ? at_time_(time) : TileSource::at_time(time);
  }

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
  const SourceAtTime at_time_;             ///< calls the stored tiles, which `blocks_` owns
  std::shared_ptr<BlockFetcher> fetcher_;  ///< null: all blocks are available without requests
};

}  // namespace

Result<TileGrid> warp_grid(const RasterInfo& raster, const WarpOptions& options, const std::string& where) {
  if (Status good = check_raster(raster, where); !good) return good.error();
  const auto map = GroundMap::open(raster, options.figure);
  if (!map) return Error{where + ": " + map.error().message};
  return grid_for(*map, raster, options, where);
}

Result<std::unique_ptr<TileSource>> warp_source(std::unique_ptr<RasterSource> raster, const WarpOptions& options,
                                                const std::string& where) {
  const RasterInfo& from = raster->info();
  const auto grid = options.grid ? Result<TileGrid>(*options.grid) : warp_grid(from, options, where);
  if (!grid) return grid.error();
  if (Status good = check_raster(from, where); !good) return good.error();
  // Blocks of a server cost requests.
  const Detail detail = raster->remote() == nullptr ? Detail::full : Detail::usual;
  auto planner = TilePlanner::open(from, options.figure, *grid, Overviews::made, detail);
  if (!planner) return Error{where + ": " + planner.error().message};
  TileSetInfo info{.name = from.name, .attribution = from.attribution, .body = options.body, .grid = *grid};
  info.format = from.opaque ? ImageFormat::jpeg : ImageFormat::png;  // format of the tiles inside the raster
  if (from.numbers) info.numbers = decoded(*from.numbers);
  return make_warp_source(std::move(raster), *std::move(planner), std::move(info), {}, options.decoded_bytes);
}

TilePlanner::TilePlanner(const RasterInfo& raster, std::shared_ptr<GroundMaps> maps, const TileGrid& grid,
                         Overviews overviews, Detail detail)
    : maps_(std::move(maps)),
      grid_(grid),
      frame_{.levels = warp_levels(raster, maps_->turn_px(), grid.tile_px, overviews), .detail = detail} {}

Result<std::shared_ptr<TilePlanner>> TilePlanner::open(const RasterInfo& raster, const WarpFigure& figure,
                                                       const TileGrid& grid, Overviews overviews, Detail detail) {
  auto maps = GroundMaps::open(raster, figure);
  if (!maps) return maps.error();
  return std::shared_ptr<TilePlanner>(new TilePlanner(raster, *std::move(maps), grid, overviews, detail));
}

Result<WarpPlan, TileFailure> TilePlanner::plan(const TileId& id) {
  return maps_->lend([&](const GroundMap& map) { return plan_tile(map_of_tile(map, grid_, id), frame_); });
}

Result<CrsPoint, TileFailure> TilePlanner::pixel_at(const RowPlace& place) {
  return maps_->lend([&](const GroundMap& map) {
    constexpr double kNone = std::numeric_limits<double>::infinity();
    CrsPoint pixel{kNone, kNone};
    map.pixels(std::span(&place, 1), std::span(&pixel, 1));
    // The turn runs along the rows of every raster that has one and is stored north up.
    if (const auto turn = map.turn_px(); turn && turn->y == 0.0 && turn->x != 0.0) {
      const double turns = std::floor(pixel.x / std::abs(turn->x));
      if (std::isfinite(turns)) pixel.x -= turns * std::abs(turn->x);
    }
    return pixel;
  });
}

std::unique_ptr<TileSource> make_warp_source(std::unique_ptr<RasterSource> raster, std::shared_ptr<TilePlanner> planner,
                                             TileSetInfo info, BlockNames names, std::size_t decoded_bytes,
                                             SourceAtTime at_time) {
  auto blocks =
      std::make_shared<const StoredBlocks>(std::move(raster), planner->frame().levels, std::move(names), decoded_bytes);
  return std::make_unique<WarpSource>(std::move(planner), std::move(blocks), std::move(info), std::move(at_time));
}

}  // namespace terrella
