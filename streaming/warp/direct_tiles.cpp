#include "streaming/warp/direct_tiles.h"

#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

#include "geo/body.h"
#include "streaming/georeference/figure.h"
#include "streaming/raster/file_source.h"
#include "streaming/warp/warp_source.h"

namespace terrella {
namespace {

Result<Body> body_of(const DirectOptions& options) {
  return options.body.empty() ? Result<Body>(earth()) : parse_body(options.body);
}

/// Place of a whole planet from -180° on.
CrsPlace planet(const PictureFile& picture) {
  const double columns = 360.0 / static_cast<double>(picture.width_px);
  const double rows = 180.0 / static_cast<double>(picture.height_px);
  return {.to_crs = {.x0 = -180.0, .x_per_column = columns, .y0 = 90.0, .y_per_row = -rows}, .crs = "EPSG:4326"};
}

}  // namespace

Result<std::optional<RasterPlace>> place_raster(PlacedPicture placed, const PictureFile& picture,
                                                const DirectOptions& options) {
  const auto body = body_of(options);
  if (!body) return body.error();
  const auto latitude = check_figure(placed, *body, options.latitude);
  if (!latitude) return latitude.error();
  if (!placed.projected) {
    if (picture.width_px != 2 * picture.height_px) return std::optional<RasterPlace>{};
    placed.projected = planet(picture);
  }
  return std::optional(RasterPlace{*std::move(placed.projected), *latitude, std::move(placed.remarks)});
}

std::string taken_for_planet(const std::string& name) {
  return name +
         ": nothing in it says where it lies, so it is taken for a whole planet from -180 degrees; files beside "
         "it on the server are not read; ‹bounds› W,S,E,N says another place";
}

std::optional<std::pair<RasterLevel, RasterLevel>> far_levels(const std::vector<RasterLevel>& levels) {
  constexpr double kTile_px = 256.0;
  constexpr double kHalf = 2.2;  // an overview of a side that does not divide evenly is a little less than half
  const auto are_far = [](const RasterLevel& coarse, const RasterLevel& fine) {
    const double step = std::max(static_cast<double>(fine.width_px) / static_cast<double>(coarse.width_px),
                                 static_cast<double>(fine.height_px) / static_cast<double>(coarse.height_px));
    const double block_px = static_cast<double>(fine.block_width_px) * fine.block_height_px;
    const double blocks = kTile_px * kTile_px * step * step / block_px;
    return step > kMostLevelStep || (step > kHalf && blocks > kMostBlocksOfStep);
  };
  const auto found = std::ranges::adjacent_find(levels, are_far);
  return found == levels.end() ? std::nullopt : std::optional(std::pair(*found, *std::next(found)));
}

bool shows_at_once(const RasterInfo& raster) {
  const RasterLevel& coarsest = raster.levels.front();
  const std::int64_t most = raster.levels.size() > 1 ? kMostCoarsestOverviewPixels : kMostCoarsestPixels;
  return !raster.by_rows && coarsest.width_px * coarsest.height_px <= most && !far_levels(raster.levels);
}

Result<std::unique_ptr<TileSource>> direct_tiles(std::unique_ptr<RasterSource> raster, const RasterPlace& place,
                                                 const DirectOptions& options, const std::string& where) {
  const auto body = body_of(options);
  if (!body) return body.error();
  WarpOptions warp{.figure = {body->ellipsoid, place.latitude, place.latitude}, .body = options.body};
  warp.grid = options.grid;
  return warp_source(std::move(raster), warp, where);
}

Result<DirectFile> open_direct(const PictureFile& picture, const DirectOptions& options) {
  auto placed = place_picture(picture, options.place);
  if (!placed) return placed.error();
  const auto place = place_raster(*std::move(placed), picture, options);
  if (!place) return place.error();
  if (!*place) return DirectFile{};
  auto raster = make_file_source(picture.raster, (*place)->at, options.reading);
  if (!raster) return raster.error();
  if (!shows_at_once((*raster)->info())) return DirectFile{};
  auto tiles = direct_tiles(*std::move(raster), **place, options, picture.path.string());
  if (!tiles) return tiles.error();
  return DirectFile{*std::move(tiles), (*place)->remarks};
}

}  // namespace terrella
