#include "tiles/tile_grid.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/hash_mix.h"

namespace terrella {
namespace {

/// A strip narrower than this part of a tile of the finest level (at most 1/250 of a pixel) is rounding, not imagery.
/// Without this limit, 360° / span = 2.0000000001 would require a third column that no server has.
constexpr double kSliverTiles = 1.0e-6;
/// Error of 360° by converting angles to and from radians, with a margin; 0.1 µm on Earth.
constexpr double kAngleNoiseDeg = 1.0e-12;

/// Slivers are measured at the finest level for all levels, so that the parent of every existing tile exists.
int finest_level(const TileGrid& grid, int level) { return std::max(level, grid.max_level); }

/// Returns the number of a level's tiles that cover an extent.
std::int64_t tiles_over(double extent_deg, const TileGrid& grid, int level) {
  constexpr double most = 0x1p53;  // above this, doubles do not represent every integer
  const int finest = finest_level(grid, level);
  const double tiles = std::min(extent_deg / tile_span_deg(grid, finest), most);
  const double rounding = 4.0 * std::numeric_limits<double>::epsilon() * tiles;
  const double whole_finest = std::ceil(tiles - std::max(kSliverTiles, rounding));
  return std::max<std::int64_t>(1, static_cast<std::int64_t>(std::ceil(std::ldexp(whole_finest, level - finest))));
}

/// Longest texel of a squeezed row along the parallel, at the edge nearest to the equator, relative to its length along
/// the meridian. With 1 the third row from a pole would have 32 tiles; with 1.2 it has 16.
constexpr double kWidestTexel = 1.2;

struct Interval {
  double from, to;
};

/// True if a tile's side overlaps the data's by at least a sliver. Data without extent (a point) touches the tiles
/// around it.
bool touches(const Interval& tile, const Interval& data, double sliver_deg) {
  const double overlap = std::min(tile.to, data.to) - std::max(tile.from, data.from);
  return overlap >= std::min(sliver_deg, 0.5 * (data.to - data.from));
}

bool touches_longitudes(const Interval& tile, const GeoRect& bounds, double sliver_deg) {
  const double west = bounds.west.deg();
  const double east = bounds.east < bounds.west ? bounds.east.deg() + 360.0 : bounds.east.deg();
  constexpr std::array turns = {-360.0, 0.0, 360.0};
  return std::ranges::any_of(turns, [&](double turn) { return touches(tile, {west + turn, east + turn}, sliver_deg); });
}

/// Ratio of the polar to the equatorial component of the direction that the grid's rows count, relative to the
/// normal's. That direction is the normal, or the radius vector of the surface point, for which tan(planetocentric) =
/// (1 - e²) tan(planetographic).
double polar_scale(const TileGrid& grid, const Ellipsoid& ellipsoid) {
  return grid.latitude == LatitudeKind::centric ? ellipsoid.one_minus_e2() : 1.0;
}

/// True for grids of a square of 360 degrees each way, which are stored and never drawn.
bool is_stored_square(Projection projection) {
  return projection == Projection::web_mercator || projection == Projection::projected;
}

double mercator_row_of(double tangent) {
  return std::clamp(std::asinh(tangent) * (180.0 / std::numbers::pi), -180.0, 180.0);
}

}  // namespace

double mercator_row_deg(double latitude_deg) {
  return mercator_row_of(std::tan(Angle::degrees(std::clamp(latitude_deg, -89.9, 89.9)).rad()));
}

double latitude_of_mercator_row_deg(double row_deg) {
  return Angle::radians(std::atan(std::sinh(Angle::degrees(std::clamp(row_deg, -180.0, 180.0)).rad()))).deg();
}

std::size_t TileIdHash::operator()(const TileId& id) const {
  const std::uint64_t row = mix_bits(static_cast<std::uint64_t>(id.y) ^ static_cast<std::uint64_t>(id.level) << 58);
  return mix_bits(row + static_cast<std::uint64_t>(id.x) + (static_cast<std::uint64_t>(id.squeeze) << 48U));
}

double tile_span_deg(const TileGrid& grid, int level) { return std::ldexp(grid.root_span_deg, -level); }

std::int64_t columns(const TileGrid& grid, int level) { return tiles_over(180.0 - grid.west_deg, grid, level); }

std::int64_t rows(const TileGrid& grid, int level) {
  return tiles_over(top_row_deg(grid) - bottom_row_deg(grid), grid, level);
}

double top_row_deg(const TileGrid& grid) { return is_stored_square(grid.projection) ? 180.0 : grid.north_deg; }

double bottom_row_deg(const TileGrid& grid) { return is_stored_square(grid.projection) ? -180.0 : -90.0; }

bool begins_at_planet(const TileGrid& grid) { return grid.west_deg == -180.0 && grid.north_deg == 90.0; }

RowLatitudes row_bounds(const TileGrid& grid) {
  const double south = grid.bounds.south.deg();
  const double north = grid.bounds.north.deg();
  if (grid.projection != Projection::web_mercator) return {south, north};
  return {mercator_row_deg(south), mercator_row_deg(north)};
}

int squeeze_of_row(const TileGrid& grid, int level, std::int64_t y) {
  if (!grid.reduced || grid.projection != Projection::equirectangular) return 0;
  const double span = tile_span_deg(grid, level);
  const double north = 90.0 - static_cast<double>(y) * span;
  const double to_equator = std::min(north < 0.0 ? -north : std::max(0.0, north - span), 90.0);
  const double narrowing = std::cos(Angle::degrees(to_equator).rad());
  // A row has at least eight tiles round a pole; a remaining strip beyond them does not reduce that number.
  const double most = std::max(1.0, static_cast<double>(columns(grid, level)) / 8.0);
  return static_cast<int>(std::floor(std::log2(std::min(most, kWidestTexel / std::max(narrowing, 1e-12)))));
}

std::int64_t squeezed_columns(const TileGrid& grid, int level, int squeeze) {
  return ((columns(grid, level) - 1) >> squeeze) + 1;
}

TileId reduced_tile(const TileGrid& grid, const TileId& full) {
  assert(full.squeeze == 0);
  const int squeeze = squeeze_of_row(grid, full.level, full.y);
  return {full.level, full.x >> squeeze, full.y, squeeze};
}

bool exists(const TileGrid& grid, const TileId& id) {
  if (id.level < grid.min_level || id.level > grid.max_level) return false;
  if (id.x < 0 || id.y < 0 || id.y >= rows(grid, id.level)) return false;
  if (id.squeeze != 0 && id.squeeze != squeeze_of_row(grid, id.level, id.y)) return false;
  if (id.x >= squeezed_columns(grid, id.level, id.squeeze)) return false;
  const TileBounds tile = tile_bounds(grid, id);
  const double sliver_deg = std::max(kSliverTiles * tile_span_deg(grid, grid.max_level), kAngleNoiseDeg);
  const RowLatitudes data = row_bounds(grid);
  const Interval data_rows{data.south_deg, data.north_deg};
  // The parts beyond ±180° are padding; they do not repeat the planet's other side.
  const Interval on_planet{std::max(tile.west_deg, -180.0), std::min(tile.east_deg, 180.0)};
  return touches({tile.south_deg, tile.north_deg}, data_rows, sliver_deg) &&
         touches_longitudes(on_planet, grid.bounds, sliver_deg);
}

TileId parent(const TileId& id) { return ancestor(id, 1); }

TileId ancestor(const TileId& id, int steps) {
  assert(steps >= 0 && steps <= id.level && id.squeeze == 0);
  return {.level = id.level - steps, .x = id.x >> steps, .y = id.y >> steps};
}

double row_latitude_deg(const TileGrid& grid, const Ellipsoid& ellipsoid, const EcefDir& normal) {
  const double polar = polar_scale(grid, ellipsoid) * normal.xyz.z;
  const double equatorial = std::hypot(normal.xyz.x, normal.xyz.y);
  if (grid.projection == Projection::web_mercator) return mercator_row_of(polar / equatorial);
  const double row = grid.projection == Projection::equal_area ? 90.0 * (polar / std::hypot(equatorial, polar))
                                                               : Angle::radians(std::atan2(polar, equatorial)).deg();
  return std::clamp(row, -90.0, 90.0);
}

Angle latitude_of_row(const TileGrid& grid, const Ellipsoid& ellipsoid, double row_latitude_deg) {
  const bool mercator = grid.projection == Projection::web_mercator;
  const double row =
      mercator ? latitude_of_mercator_row_deg(row_latitude_deg) : std::clamp(row_latitude_deg, -90.0, 90.0);
  const bool equal_area = grid.projection == Projection::equal_area;
  if (!equal_area && grid.latitude == LatitudeKind::graphic) return Angle::degrees(row);
  const double sine = equal_area ? row / 90.0 : std::sin(Angle::degrees(row).rad());
  const double cosine = equal_area ? std::sqrt((1.0 - sine) * (1.0 + sine)) : std::cos(Angle::degrees(row).rad());
  return Angle::radians(std::atan2(sine, polar_scale(grid, ellipsoid) * cosine));
}

TileXY tile_xy(const TileGrid& grid, int level, double row_latitude_deg, double lon_deg) {
  const double span = tile_span_deg(grid, level);
  return {.x = (lon_deg - grid.west_deg) / span, .y = (top_row_deg(grid) - row_latitude_deg) / span};
}

TileBounds tile_bounds(const TileGrid& grid, const TileId& id) {
  const double span = tile_span_deg(grid, id.level);
  const double width = std::ldexp(span, id.squeeze);
  const double top = top_row_deg(grid);
  const auto x = static_cast<double>(id.x);
  const auto y = static_cast<double>(id.y);
  return {.west_deg = grid.west_deg + x * width,
          .south_deg = top - (y + 1.0) * span,
          .east_deg = grid.west_deg + (x + 1.0) * width,
          .north_deg = top - y * span};
}

}  // namespace terrella
