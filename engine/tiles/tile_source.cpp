#include "tiles/tile_source.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <new>

#include "base/range_check.h"
#include "geo/longitudes.h"
#include "tiles/height_decoder.h"

namespace terrella {
namespace {

Result<double, TileFailure> value_of(const EncodedTile& tile, const TileSetInfo& set, double x, double y) {
  const int side_px = set.grid.tile_px;
  const auto numbers = decode_numbers(tile, *set.numbers, side_px);
  if (!numbers) return numbers.error();
  const auto pixel = [side_px](double part) {
    return static_cast<std::size_t>(std::clamp(static_cast<int>(part * side_px), 0, side_px - 1));
  };
  const double number = numbers->values[pixel(y) * static_cast<std::size_t>(side_px) + pixel(x)];
  if (std::isnan(number)) return TileFailure{MissingKind::blank, "no data"};
  return (number * tile.number_scale + tile.number_offset) * set.numbers->scale + set.numbers->offset;
}

}  // namespace

TileFailure caught_failure() {
  try {
    throw;
  } catch (const std::bad_alloc&) {
    return {MissingKind::failed, "not enough memory"};
  } catch (const std::exception& error) {
    return {MissingKind::failed, error.what()};
  } catch (...) {
    return {MissingKind::failed, "the tile source threw an exception of its own type"};
  }
}

Status check_numbers(const NumberInfo& info) {
  return RangeCheck()
      .finite("their scale", info.scale)
      .that(info.scale != 0.0, "their scale is 0; give the value of a step")
      .finite("their offset", info.offset)
      .in("their period", info.period, 0.0, 1e9)
      .that(!info.whole || info.whole->least <= info.whole->most, "their range of whole numbers is empty")
      .result();
}

Result<std::unique_ptr<TileSource>> TileSource::at_time(UtcTime time) {
  static_cast<void>(time);
  const std::string& name = info().name;
  return Error{(name.empty() ? "the tiles" : name) + ": has no list of times, so it is the same at all times"};
}

Result<double, TileFailure> TileSource::value_at(const Geodetic& place, const Ellipsoid& figure) {
  const TileSetInfo& set = info();
  if (!set.numbers) return TileFailure{MissingKind::absent, "the tiles are pictures"};
  const double row_deg = row_latitude_deg(set.grid, figure, Ellipsoid::normal(place.lat, place.lon));
  const double lon_deg = -180.0 + degrees_east(place.lon.deg(), -180.0);
  for (int level = set.grid.max_level; level >= set.grid.min_level; --level) {
    const TileXY at = tile_xy(set.grid, level, row_deg, lon_deg);
    const TileId id{.level = level,
                    .x = static_cast<std::int64_t>(std::floor(at.x)),
                    .y = std::min(static_cast<std::int64_t>(std::floor(at.y)), rows(set.grid, level) - 1)};
    if (!exists(set.grid, id)) continue;
    const auto tile = read(id);
    if (tile) return value_of(*tile, set, at.x - static_cast<double>(id.x), at.y - static_cast<double>(id.y));
    if (tile.error().kind != MissingKind::absent) return tile.error();
  }
  return TileFailure{MissingKind::absent, "outside the tiles"};
}

}  // namespace terrella
