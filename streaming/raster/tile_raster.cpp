#include "streaming/raster/tile_raster.h"

#include <cmath>
#include <numbers>
#include <utility>

namespace terrella {
namespace {

/// A part of a pixel under this is rounding.
constexpr double kSliverPx = 1e-3;

std::int64_t pixels_over(double extent_deg, double pixel_deg) {
  return std::max<std::int64_t>(1, std::llround(std::ceil(extent_deg / pixel_deg - kSliverPx)));
}

/// EPSG:3857; its coordinates end at ±π · 6378137 m.
constexpr double kMercatorHalf_m = std::numbers::pi * 6378137.0;

CrsSquare square_of(const TileSetInfo& info) {
  if (info.grid.projection == Projection::projected) return info.square.value_or(CrsSquare{});
  if (info.grid.projection != Projection::web_mercator) {
    return {.crs = {}, .west = info.grid.west_deg, .north = info.grid.north_deg};
  }
  return {
      .crs = "EPSG:3857", .west = -kMercatorHalf_m, .north = kMercatorHalf_m, .unit_per_deg = kMercatorHalf_m / 180.0};
}

RasterLevel placed_level(const CrsLevel& level, int tile_px) {
  return {.width_px = level.columns * tile_px,
          .height_px = level.rows * tile_px,
          .block_width_px = tile_px,
          .block_height_px = tile_px,
          .to_crs = {.x0 = level.west,
                     .x_per_column = level.unit_per_px,
                     .x_per_row = 0.0,
                     .y0 = level.north,
                     .y_per_column = 0.0,
                     .y_per_row = -level.unit_per_px}};
}

RasterLevel level_of(const TileGrid& grid, const CrsSquare& square, int level) {
  const auto number = static_cast<std::size_t>(level);
  if (number < square.levels.size()) return placed_level(square.levels[number], grid.tile_px);
  const double pixel_deg = tile_span_deg(grid, level) / grid.tile_px;
  const double pixel = pixel_deg * square.unit_per_deg;
  const RowLatitudes rows = row_bounds(grid);
  const double west_deg = grid.projection == Projection::web_mercator ? -180.0 : grid.west_deg;
  const bool crosses = grid.bounds.east.deg() <= grid.bounds.west.deg();
  return {.width_px = pixels_over((crosses ? 180.0 : grid.bounds.east.deg()) - west_deg, pixel_deg),
          .height_px = pixels_over(top_row_deg(grid) - rows.south_deg, pixel_deg),
          .block_width_px = grid.tile_px,
          .block_height_px = grid.tile_px,
          .to_crs = {.x0 = square.west,
                     .x_per_column = pixel,
                     .x_per_row = 0.0,
                     .y0 = square.north,
                     .y_per_column = 0.0,
                     .y_per_row = -pixel}};
}

}  // namespace

RasterInfo raster_info_of(const TileSetInfo& tiles) {
  const CrsSquare square = square_of(tiles);
  RasterInfo info{.name = tiles.name,
                  .attribution = tiles.attribution,
                  .crs = square.crs,
                  .levels = {},
                  .opaque = false,
                  .numbers = tiles.numbers};
  for (int level = tiles.grid.min_level; level <= tiles.grid.max_level; ++level) {
    info.levels.push_back(level_of(tiles.grid, square, level));
  }
  return info;
}

namespace {

class TileRaster : public RasterSource, public RemoteTiles {
 public:
  explicit TileRaster(std::shared_ptr<TileSource> stored)
      : stored_(std::move(stored)), info_(raster_info_of(stored_->info())) {}

  [[nodiscard]] const RasterInfo& info() const override { return info_; }
  [[nodiscard]] Result<EncodedTile, TileFailure> read(const TileId& block) override {
    const TileId id = tile_of(block);
    if (!exists(stored_->info().grid, id)) return TileFailure{MissingKind::blank, "outside the tile set"};
    return stored_->read(id);
  }
  [[nodiscard]] RemoteTiles* remote() override { return stored_->remote() != nullptr ? this : nullptr; }

  void fetch(const TileId& block, double priority, Done done) override {
    stored_->remote()->fetch(tile_of(block), priority, std::move(done));
  }
  void set_priority(const TileId& block, double priority) override {
    stored_->remote()->set_priority(tile_of(block), priority);
  }
  void cancel(const TileId& block) override { stored_->remote()->cancel(tile_of(block)); }

 private:
  /// The levels of a raster begin at 0.
  [[nodiscard]] TileId tile_of(const TileId& block) const {
    return {.level = block.level + stored_->info().grid.min_level, .x = block.x, .y = block.y};
  }

  const std::shared_ptr<TileSource> stored_;
  const RasterInfo info_;
};

}  // namespace

std::unique_ptr<RasterSource> raster_of_tiles(std::shared_ptr<TileSource> stored) {
  return std::make_unique<TileRaster>(std::move(stored));
}

}  // namespace terrella
