#include "streaming/warp/warp_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "streaming/warp/make_warp_source.h"
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
  const double pixel_deg = pixel_size_deg(*per_degree);
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

}  // namespace terrella
