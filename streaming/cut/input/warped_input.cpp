#include "streaming/cut/input/warped_input.h"

#include <fmt/format.h>

#include <cmath>

#include "geo/body.h"
#include "streaming/cut/input/cut_input.h"
#include "streaming/cut/input/picture_raster.h"
#include "streaming/cut/input/rolled_rows.h"
#include "streaming/cut/input/tile_rows.h"
#include "streaming/mosaic/mosaic_tiles.h"
#include "streaming/warp/warp_source.h"

namespace terrella {
namespace {

double width_deg(const GeoRect& bounds) {
  const double width = bounds.east.deg() - bounds.west.deg();
  return width > 0.0 ? width : width + 360.0;
}

bool is_planet(const GeoRect& bounds) {
  constexpr double kRounding_deg = 1e-9;
  return width_deg(bounds) > 360.0 - kRounding_deg && bounds.north.deg() - bounds.south.deg() > 180.0 - kRounding_deg;
}

/// Rows without transparency, so that tiles become JPEG.
class OpaqueRows : public RowReader {
 public:
  explicit OpaqueRows(std::unique_ptr<RowReader> rows) : rows_(std::move(rows)), info_(rows_->info()) {
    info_.has_alpha = false;
  }
  [[nodiscard]] const PictureInfo& info() const override { return info_; }
  [[nodiscard]] Status read_row(std::span<std::uint8_t> rgba) override {
    Status read = rows_->read_row(rgba);
    for (std::size_t i = 3; i < rgba.size(); i += 4) rgba[i] = 255;
    return read;
  }
  [[nodiscard]] Status skip_rows(std::int64_t rows) override { return rows_->skip_rows(rows); }

 private:
  std::unique_ptr<RowReader> rows_;
  PictureInfo info_;
};

struct RemarkLog {
  std::vector<std::string> remarks;
  bool ended = false;
};

/// A set without its network side: tiles of the finest level of a mosaic are all local.
class LocalTiles : public TileSource {
 public:
  explicit LocalTiles(std::unique_ptr<TileSource> tiles) : tiles_(std::move(tiles)) {}
  [[nodiscard]] const TileSetInfo& info() const override { return tiles_->info(); }
  [[nodiscard]] Result<EncodedTile, TileFailure> read(const TileId& id) override { return tiles_->read(id); }

 private:
  std::unique_ptr<TileSource> tiles_;
};

/// Makes a picture of all longitudes from one that crosses ±180° and would reach the same tile from both sides.
void roll_if_needed(const CutOptions& options, WarpedInput& warped, bool heights) {
  const PictureInfo& info = warped.rows->info();
  if (!meets_itself(options, info, warped.bounds)) return;
  const double pixel_deg = width_deg(warped.bounds) / static_cast<double>(info.width_px);
  const auto turn = std::llround(360.0 / pixel_deg);
  const auto first = std::llround((warped.bounds.west.deg() + 180.0) / pixel_deg);
  warped.rows = rolled_rows(std::move(warped.rows), first, turn, heights);
  warped.bounds = all_round(warped.bounds);
}

/// Opens the files of a mosaic, with the band that is cut.
std::function<Result<std::unique_ptr<RasterSource>>(const std::filesystem::path&, const CrsPlace&,
                                                    const RasterOptions&)>
reader_of(const CutOptions& options) {
  const int band = options.numbers && options.numbers->band > 1 ? options.numbers->band : 0;
  return [band](const std::filesystem::path& path, const CrsPlace& place, RasterOptions reading) {
    if (band > 0) reading.band = band;
    return open_picture_raster(path, place, reading);
  };
}

}  // namespace

Result<WarpedInput> open_warped(const CutOptions& options, const PictureFile& picture, const PicturePlace& place,
                                const std::optional<HeightPlan>& heights) {
  const std::string name = picture.path.string();
  const auto body = options.body.empty() ? Result<Body>(earth()) : parse_body(options.body);
  if (!body) return body.error();
  RasterOptions reading = heights ? raster_of(*heights) : RasterOptions{};
  reading.work_folder = options.output.parent_path();
  reading.jobs = options.jobs;
  if (!heights) {
    const CodingOptions choice = choice_of(options);
    reading.nodata = choice.nodata;
    reading.composite = choice.composite;
  }
  auto raster = options.raster   ? options.raster->open(*place.from, reading)
                : picture.raster ? raster_source(picture.raster, *place.from, reading)
                                 : open_picture_raster(picture.path, *place.from, reading);
  if (!raster) return raster.error();
  const bool opaque = (*raster)->info().opaque && place.placed.placement;
  WarpOptions warp{.figure = {body->ellipsoid, place.latitude, place.latitude}, .body = options.body};
  const auto grid = warp_grid((*raster)->info(), warp, name);
  if (!grid) return grid.error();
  const double columns = width_deg(grid->bounds) * grid->tile_px / tile_span_deg(*grid, grid->max_level);
  warp.tile_px = tile_side_for_rows(std::llround(columns));
  auto tiles = warp_source(*std::move(raster), warp, name);
  if (!tiles) return tiles.error();
  auto rows =
      open_tile_rows(*std::move(tiles), options.jobs, heights ? std::optional(heights->numbers) : std::nullopt, name);
  if (!rows) return rows.error();
  WarpedInput warped{.rows = std::move(rows->rows), .bounds = rows->bounds};
  // Parallels and meridians as edges leave no gap on a whole planet.
  if (opaque && !heights && is_planet(warped.bounds)) {
    warped.rows = std::make_unique<OpaqueRows>(std::move(warped.rows));
  }
  roll_if_needed(options, warped, heights.has_value());
  return warped;
}

Result<MosaicList> list_of(const CutOptions& options) {
  if (options.images.size() == 1) return read_mosaic_list(options.images.front());
  MosaicList list;
  for (const auto& image : options.images) list.entries.push_back({.path = image});
  return list;
}

Result<WarpedInput> open_many(const CutOptions& options, const std::optional<HeightPlan>& heights,
                              std::vector<std::string>& remarks) {
  const std::string name = options.images.front().string();
  const auto body = options.body.empty() ? Result<Body>(earth()) : parse_body(options.body);
  if (!body) return body.error();
  auto list = list_of(options);
  if (!list) return list.error();
  MosaicOptions mosaic;
  mosaic.pixels = options.elevation ? MosaicPixels::heights
                  : options.numbers ? MosaicPixels::as_stored
                                    : MosaicPixels::colours;
  mosaic.figure = {.body = *body, .latitude = options.latitude};
  mosaic.body = options.body;
  mosaic.reading = {.measure = measure_picture, .open = reader_of(options)};
  const auto left_out = std::make_shared<std::atomic<int>>(0);
  mosaic.left_out = [left_out](int files) { *left_out += files; };
  mosaic.jobs = options.jobs;
  mosaic.work_folder = options.output.parent_path();
  // Remarks of the opening are returned; those of the reading come while the caller has gone on.
  const auto log = std::make_shared<RemarkLog>();
  mosaic.remark = [log, said = options.remark](const std::string& reason) {
    if (!log->ended) {
      log->remarks.push_back(reason);
    } else if (said) {
      said(reason);
    }
  };
  if (options.numbers) {
    for (MosaicEntry& entry : list->entries) {
      if (options.numbers->nodata) entry.nodata = options.numbers->nodata;
    }
  } else if (heights) {
    const RasterOptions reading = raster_of(*heights);
    for (MosaicEntry& entry : list->entries) {
      entry.nodata = reading.nodata;
      entry.scale = reading.scale;
      entry.offset = reading.offset;
    }
  }
  auto tiles = open_mosaic(*list, name, mosaic);
  if (!tiles) return tiles.error();
  const TileGrid& grid = (*tiles)->info().grid;
  const double columns = width_deg(grid.bounds) * grid.tile_px / tile_span_deg(grid, grid.max_level);
  mosaic.tile_px = tile_side_for_rows(std::llround(columns));
  if (mosaic.tile_px != grid.tile_px) {
    log->remarks.clear();
    *left_out = 0;
    tiles = open_mosaic(*list, name, mosaic);
    if (!tiles) return tiles.error();
  }
  if (heights && !(*tiles)->info().numbers) {
    return Error{
        fmt::format("{}: its files are pictures, and no numbers; leave ‹band›, ‹nodata› and ‹elevation› out", name)};
  }
  const LatitudeKind latitude = (*tiles)->info().grid.latitude;
  log->ended = true;
  remarks = log->remarks;
  auto rows = open_tile_rows(std::make_unique<LocalTiles>(*std::move(tiles)), options.jobs,
                             heights ? std::optional(heights->numbers) : std::nullopt, name);
  if (!rows) return rows.error();
  WarpedInput warped{.rows = std::move(rows->rows), .bounds = rows->bounds, .latitude = latitude, .left_out = left_out};
  roll_if_needed(options, warped, heights.has_value());
  return warped;
}

}  // namespace terrella
