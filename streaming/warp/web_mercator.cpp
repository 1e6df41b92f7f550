#include "streaming/warp/web_mercator.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <utility>

#include "geo/body.h"
#include "streaming/sets/tileset_check.h"
#include "streaming/warp/make_warp_source.h"

namespace terrella {
namespace {

/// A finer level is not used for a shortfall below this fraction of a level.
constexpr double kOctaveSlack = 0.02;
constexpr double kHalf_m = std::numbers::pi * 6378137.0;

RasterInfo raster_of(const TileSetInfo& set) {
  const TileGrid& grid = set.grid;
  RasterInfo raster{
      .name = set.name, .attribution = set.attribution, .crs = "EPSG:3857", .levels = {}, .elevation = set.elevation};
  for (int level = grid.min_level; level <= grid.max_level; ++level) {
    const std::int64_t side_px = columns(grid, level) * grid.tile_px;
    const double pixel_m = 2.0 * kHalf_m / static_cast<double>(side_px);
    raster.levels.push_back({.width_px = side_px,
                             .height_px = side_px,
                             .block_width_px = grid.tile_px,
                             .block_height_px = grid.tile_px,
                             .to_crs = {-kHalf_m, pixel_m, 0.0, kHalf_m, 0.0, -pixel_m}});
  }
  return raster;
}

/// The tiles of a set as blocks of a raster in EPSG:3857.
class TileRaster : public RasterSource, public RemoteTiles {
 public:
  explicit TileRaster(std::unique_ptr<TileSource> tiles) : tiles_(std::move(tiles)), info_(raster_of(tiles_->info())) {}

  [[nodiscard]] const RasterInfo& info() const override { return info_; }
  [[nodiscard]] Result<EncodedTile, TileFailure> read(const TileId& block) override {
    const TileId id = tile_of(block);
    if (!exists(tiles_->info().grid, id)) return TileFailure{MissingKind::blank, "outside the tile set"};
    return tiles_->read(id);
  }
  [[nodiscard]] RemoteTiles* remote() override { return tiles_->remote() != nullptr ? this : nullptr; }

  void fetch(const TileId& block, double priority, Done done) override {
    tiles_->remote()->fetch(tile_of(block), priority, std::move(done));
  }
  void set_priority(const TileId& block, double priority) override {
    tiles_->remote()->set_priority(tile_of(block), priority);
  }
  void cancel(const TileId& block) override { tiles_->remote()->cancel(tile_of(block)); }

 private:
  [[nodiscard]] TileId tile_of(const TileId& block) const {
    return {.level = block.level + tiles_->info().grid.min_level, .x = block.x, .y = block.y};
  }

  const std::unique_ptr<TileSource> tiles_;
  const RasterInfo info_;
};

/// Rows of the tiles count the same latitude as the stored tiles'.
WarpFigure figure_of(const TileGrid& grid) {
  return {.ellipsoid = earth().ellipsoid, .latitude = grid.latitude, .crs_latitude = grid.latitude};
}

}  // namespace

TileGrid geodetic_grid_of(const TileGrid& mercator) {
  assert(mercator.projection == Projection::web_mercator);
  TileGrid grid = mercator;
  grid.projection = Projection::equirectangular;
  const auto within = [](Angle side) {
    return Angle::degrees(std::clamp(side.deg(), -kMercatorEndDeg, kMercatorEndDeg));
  };
  grid.bounds.south = within(mercator.bounds.south);
  grid.bounds.north = within(mercator.bounds.north);
  const double farthest = std::max(std::abs(grid.bounds.south.deg()), std::abs(grid.bounds.north.deg()));
  const double cosine = std::cos(Angle::degrees(farthest).rad());
  const int further = static_cast<int>(std::floor(-std::log2(cosine) + kOctaveSlack));
  grid.max_level = std::min(mercator.max_level + std::max(further, 0), kMaxTileLevel);
  return grid;
}

Result<std::set<TileId>> stored_tiles_of(const TileGrid& mercator, std::span<const TileId> geodetic) {
  TileSetInfo set;
  set.grid = mercator;
  const RasterInfo raster = raster_of(set);
  auto planner = TilePlanner::open(raster, figure_of(mercator), geodetic_grid_of(mercator), Overviews::stored);
  if (!planner) return planner.error();
  std::set<TileId> stored;
  for (const TileId& id : geodetic) {
    for (const WarpPiece& piece : (*planner)->plan(id).pieces) {
      const TileId tile{.level = piece.id.level + mercator.min_level, .x = piece.id.x, .y = piece.id.y};
      if (exists(mercator, tile)) stored.insert(tile);
    }
  }
  return stored;
}

Result<std::unique_ptr<TileSource>> as_geodetic(std::unique_ptr<TileSource> stored, const std::string& where) {
  TileSetInfo info = stored->info();
  if (info.grid.projection != Projection::web_mercator) return stored;
  const TileGrid mercator = info.grid;
  info.made_of = mercator;
  info.grid = geodetic_grid_of(mercator);
  if (Status good = check_grid(info.grid, where + ": between the ends of Web Mercator"); !good) return good.error();
  if (info.elevation) {
    info.elevation = ElevationInfo{.scale = info.elevation->scale, .offset = info.elevation->offset, .floats = true};
  }
  auto raster = std::make_unique<TileRaster>(std::move(stored));
  auto planner = TilePlanner::open(raster->info(), figure_of(mercator), info.grid, Overviews::stored);
  if (!planner) return Error{where + ": " + planner.error().message};
  return make_warp_source(std::move(raster), *std::move(planner), std::move(info),
                          {.noun = "Web Mercator tile", .first_level = mercator.min_level}, kWarpDecodedBytes);
}

}  // namespace terrella
