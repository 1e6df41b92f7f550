#include "tiles/elevation_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "geo/longitudes.h"
#include "tiles/grid_ranges.h"
#include "tiles/height_decoder.h"
#include "tiles/tile_range.h"

namespace terrella {
namespace {

/// Units that mean metres; a set without a unit is taken for metres.
constexpr std::array<std::string_view, 5> kMetres = {"", "m", "metre", "meter", "metres"};

/// Number of tiles of the coarsest level that are tried to find an existing one.
constexpr std::int64_t kMaxLookedAt = 64;

std::string text_of(const GeoRect& rect) {
  return fmt::format("{:.6g},{:.6g},{:.6g},{:.6g}", rect.west.deg(), rect.south.deg(), rect.east.deg(),
                     rect.north.deg());
}

bool holds(const GeoRect& outer, const GeoRect& inner, double slack_deg) {
  if (inner.north.deg() > outer.north.deg() + slack_deg || inner.south.deg() < outer.south.deg() - slack_deg) {
    return false;
  }
  if (width_deg(outer) >= 360.0 - slack_deg) return true;
  // Counts from a little west of the outer border, so that a shared border does not count as a full turn.
  const double from = degrees_east(inner.west.deg(), outer.west.deg() - slack_deg);
  return from + width_deg(inner) <= width_deg(outer) + 2.0 * slack_deg;
}

}  // namespace

Result<ElevationSource> ElevationSource::open(std::shared_ptr<TileSource> tiles, const std::string& name,
                                              const GeoRect& covered) {
  if (!tiles) return Error{name + ": there is no tile set; open one first (open_tile_set())"};
  const TileSetInfo& info = tiles->info();
  if (Status good = check_grid(info.grid, name); !good) return good.error();
  if (!info.numbers) {
    return Error{
        fmt::format("{}: its tiles are pictures, not heights; ‹cut› ‹elevation› makes tiles of heights of a "
                    "picture of 16 bits or floats, gdal_translate -of GPKG of a raster of Int16 or Float32",
                    name)};
  }
  if (Status good = check_numbers(*info.numbers); !good) return Error{name + ": " + good.error().message};
  if (std::ranges::find(kMetres, info.numbers->unit) == kMetres.end()) {
    return Error{fmt::format("{}: its numbers are in \"{}\", heights must be in metres (gdal_calc.py converts them)",
                             name, info.numbers->unit)};
  }
  const double pixel_deg = tile_span_deg(info.grid, info.grid.max_level) / info.grid.tile_px;
  if (!holds(info.grid.bounds, covered, 0.5 * pixel_deg)) {
    return Error{
        fmt::format("{}: its heights cover {} (west, south, east, north) and must cover {}; give heights for all of it "
                    "(gdalwarp -te, heights of 0 where there are none)",
                    name, text_of(info.grid.bounds), text_of(covered))};
  }
  if (const Status roots = check_root_tiles(info.grid); !roots) return Error{name + ": " + roots.error().message};
  ElevationSource source(std::move(tiles));
  if (Status first = source.try_first_tile(name); !first) return first.error();
  return source;
}

Status ElevationSource::try_first_tile(const std::string& name) const {
  Status good = Done{};
  std::int64_t left = kMaxLookedAt;
  for_each_place(grid(), grid().min_level, [&](const TileId& id) {
    const auto heights = read(id);
    if (heights) return false;
    if (heights.error().kind != MissingKind::broken) return --left > 0;
    good = Error{fmt::format("{}: the tile of level {}, column {}, row {} is no tile of heights: {}", name, id.level,
                             id.x, id.y, heights.error().why)};
    return false;
  });
  return good;
}

Result<HeightTile, TileFailure> ElevationSource::read(const TileId& id) const {
  const auto tile = tiles_->read(id);
  if (!tile) return tile.error();
  return decode(id, *tile);
}

Result<HeightTile, TileFailure> ElevationSource::decode(const TileId& id, const EncodedTile& tile) const {
  const TileSetInfo& info = tiles_->info();
  return decode_heights(id, tile, *info.numbers, info.grid.tile_px);
}

}  // namespace terrella
