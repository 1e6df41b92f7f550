#include "tiles/grid_ranges.h"

#include <fmt/format.h>

#include <cmath>

#include "base/range_check.h"

namespace terrella {
namespace {

Error field_error(const std::string& where, const char* field, double value, const std::string& allowed) {
  return Error{fmt::format("{}: {} is {}, it must be {}", where, field, value, allowed)};
}

// Conversion to radians and back may move a bound over ±180° or ±90° by rounding.
constexpr double kAngleSlackDeg = 1e-9;

bool within(double value, double low, double high) {
  return value >= low - kAngleSlackDeg && value <= high + kAngleSlackDeg;
}

Status check_bounds(const TileGrid& grid, const std::string& where) {
  const GeoRect& bounds = grid.bounds;
  const double top = grid.projection == Projection::projected ? 180.0 : 90.0;
  for (const double lon : {bounds.west.deg(), bounds.east.deg()}) {
    if (!within(lon, -180.0, 180.0)) return field_error(where, "bounds: a longitude", lon, "in [-180, 180]");
  }
  for (const double lat : {bounds.south.deg(), bounds.north.deg()}) {
    if (!within(lat, -top, top))
      return field_error(where, "bounds: a latitude", lat, fmt::format("in [-{0}, {0}]", top));
  }
  if (!(bounds.south < bounds.north)) {
    return field_error(where, "bounds: south", bounds.south.deg(), fmt::format("under north, {}", bounds.north.deg()));
  }
  if (grid.projection == Projection::projected && !(bounds.west < bounds.east)) {
    return field_error(where, "bounds: west", bounds.west.deg(), "under east");
  }
  if (bounds.west == bounds.east) return field_error(where, "bounds: west", bounds.west.deg(), "other than east");
  return Done{};
}

/// Checks that the tiles form a quadtree over the square: 360° and its quarters.
Status check_mercator(const TileGrid& grid, const std::string& where) {
  if (grid.projection != Projection::web_mercator) return Done{};
  const double halvings = std::log2(360.0 / grid.root_span_deg);
  if (halvings < 0.0 || halvings != std::round(halvings)) {
    return field_error(where, "root span (‹root_span_deg›, in JSON root_span_deg)", grid.root_span_deg,
                       "360 or a half, a quarter … of it in Web Mercator");
  }
  if (grid.tile_px > kMaxMercatorTilePx) {
    return field_error(where, "tile_px", grid.tile_px, fmt::format("at most {} in Web Mercator", kMaxMercatorTilePx));
  }
  if (grid.reduced) return Error{where + ": polar_rows are not squeezed in Web Mercator, which has no poles"};
  return Done{};
}

Status check_origin(const TileGrid& grid, const std::string& where) {
  if (begins_at_planet(grid)) return Done{};
  if (!(grid.west_deg <= -180.0 && grid.west_deg > -180.0 - grid.root_span_deg)) {
    return field_error(where, "origin_west_deg", grid.west_deg, "-180 or less, by under one root span");
  }
  if (!(grid.north_deg >= 90.0 && grid.north_deg < 90.0 + grid.root_span_deg)) {
    return field_error(where, "origin_north_deg", grid.north_deg, "90 or more, by under one root span");
  }
  const bool crosses = grid.bounds.east < grid.bounds.west && grid.west_deg != -180.0;
  if (grid.projection == Projection::web_mercator || grid.reduced || crosses) {
    return Error{where +
                 ": an origin other than (-180, 90) is not for Web Mercator, nor for grids with polar_rows or bounds "
                 "that cross 180 degrees"};
  }
  return Done{};
}

}  // namespace

Status check_grid(const TileGrid& grid, const std::string& where) {
  const Status known = RangeCheck()
                           .known("projection", grid.projection, Projection::projected)
                           .known("latitude", grid.latitude, LatitudeKind::centric)
                           .result();
  if (!known) return Error{where + ": " + known.error().message};
  if (!(grid.root_span_deg >= kMinRootSpanDeg && grid.root_span_deg <= kMaxRootSpanDeg)) {
    return field_error(where, "root span (‹root_span_deg›, in JSON root_span_deg)", grid.root_span_deg,
                       fmt::format("in [{}, {}] degrees", kMinRootSpanDeg, kMaxRootSpanDeg));
  }
  if (grid.tile_px < kMinTilePx || grid.tile_px > kMaxTilePx) {
    return field_error(where, "tile_px", grid.tile_px, fmt::format("in [{}, {}]", kMinTilePx, kMaxTilePx));
  }
  if (grid.max_level < 0 || grid.max_level > kMaxTileLevel) {
    return field_error(where, "max_level", grid.max_level, fmt::format("in [0, {}]", kMaxTileLevel));
  }
  if (grid.min_level < 0 || grid.min_level > grid.max_level) {
    return field_error(where, "min_level", grid.min_level, fmt::format("in [0, max_level = {}]", grid.max_level));
  }
  if (Status square = check_mercator(grid, where); !square) return square.error();
  if (Status origin = check_origin(grid, where); !origin) return origin.error();
  return check_bounds(grid, where);
}

}  // namespace terrella
