#pragma once

#include <compare>
#include <cstdint>
#include <optional>
#include <utility>

#include "geo/coordinates.h"
#include "geo/ellipsoid.h"

// thread: any, for all of this header
namespace terrella {

/// How a row of the imagery relates to latitude. Paper 1's (3) is `equirectangular` (rows linear in latitude), its (4)
/// is `equal_area` (Lambert's cylinder, rows linear in the sine); the paper names them the other way round.
/// `web_mercator` is EPSG:3857's square (rows linear in asinh(tan(latitude))): tiles as they are stored, which
/// streaming/mercator makes equirectangular ones of; nothing is drawn of such a grid itself.
enum class Projection { equirectangular, equal_area, web_mercator };

/// Where the square of Web Mercator ends: atan(sinh(π)), degrees.
inline constexpr double kMercatorEndDeg = 85.05112877980659;
/// The row of Web Mercator that a latitude in [-90°, 90°] is on: -180 at its southern end, 180 at its northern, beyond
/// both the same. EPSG guidance note 7-2, 3.2.1.2 ("Popular Visualisation Pseudo Mercator").
[[nodiscard]] double mercator_row_deg(double latitude_deg);
/// The inverse, in [-kMercatorEndDeg, kMercatorEndDeg].
[[nodiscard]] double latitude_of_mercator_row_deg(double row_deg);

/// Which latitude the rows count: `graphic` geodetic (planetographic), `centric` planetocentric.
enum class LatitudeKind { graphic, centric };

/// A tile of a grid: level, column from the west, row from the NORTH. Other row orders are converted at the source.
/// A squeezed tile of a reduced row spans 2^squeeze columns, and x counts such wide columns.
struct TileId {
  int level = 0;
  std::int64_t x = 0;
  std::int64_t y = 0;
  int squeeze = 0;
  auto operator<=>(const TileId&) const = default;
};
struct TileIdHash {
  [[nodiscard]] std::size_t operator()(const TileId& id) const;
};
inline constexpr int kMaxTileLevel = 24;

/// A quadtree grid over longitude and latitude with origin (-180°, +90°), clipped to the planet (engine/DESIGN.md,
/// 4). Degrees of "row latitude": for equal_area grids one degree is 1/180 of the picture's height, for
/// web_mercator 1/360: its rows run from +180 to -180, and so the origin is (-180°, +180).
struct TileGrid {
  double root_span_deg = 180.0;  ///< what a level-0 tile spans, degrees, both ways; (0, 1e4]
  int tile_px = 256;             ///< pixels a side, [16, 4096]
  int min_level = 0;
  int max_level = 0;  ///< [min_level, kMaxTileLevel]
  Projection projection = Projection::equirectangular;
  LatitudeKind latitude = LatitudeKind::graphic;
  GeoRect bounds{};      ///< where there is data, in row latitude (web_mercator: latitude); whole planet by default
  bool reduced = false;  ///< rows near the poles are there squeezed as well (squeeze_of_row())
  bool operator==(const TileGrid&) const = default;
};

/// Continuous tile coordinates of a level: x east from -180° in tiles, y south from +90° in tiles.
struct TileXY {
  double x;
  double y;
};

[[nodiscard]] double tile_span_deg(const TileGrid& grid, int level);  ///< root_span / 2^level
/// Row latitude of the grid's northern edge; the southern one is as far from 0: 90, of web_mercator 180.
[[nodiscard]] double top_row_deg(const TileGrid& grid);
struct RowLatitudes {
  double south_deg, north_deg;
};
[[nodiscard]] RowLatitudes row_bounds(const TileGrid& grid);  ///< the bounds in row latitude, whatever the projection
/// Matrix size. A strip under 1e-6 of a tile of the finest level is rounding and gets no tile of its own; because all
/// levels are counted from the finest, every tile that exists has a parent that exists (down to min_level).
[[nodiscard]] std::int64_t columns(const TileGrid& grid, int level);  ///< tiles that reach over [-180°, 180°], ≥ 1
/// The same of a row that is squeezed 2^squeeze times.
[[nodiscard]] std::int64_t squeezed_columns(const TileGrid& grid, int level, int squeeze);
[[nodiscard]] std::int64_t rows(const TileGrid& grid, int level);  ///< tiles that reach over [90°, -90°], ≥ 1
/// Of a reduced grid, as weather models have: the largest k for which texels 2^k times as wide are at most a fifth
/// longer along the parallel than along the meridian, at the row's edge nearest to the equator (engine/DESIGN.md,
/// 12). 0 for other rows, and for grids that are not reduced or have equal-area rows.
[[nodiscard]] int squeeze_of_row(const TileGrid& grid, int level, std::int64_t y);
/// The tile to use for a place in the full grid: the squeezed one over it where the row is reduced, else itself.
[[nodiscard]] TileId reduced_tile(const TileGrid& grid, const TileId& full);
/// True if the tile exists on the planet, in the level range and touches the bounds.
[[nodiscard]] bool exists(const TileGrid& grid, const TileId& id);
[[nodiscard]] TileId parent(const TileId& id);  ///< of a full tile, id.level ≥ 1
/// The ancestor of a full tile `steps` levels up.
[[nodiscard]] TileId ancestor(const TileId& id, int steps);

/// Row latitude of a geodetic normal, in [-90°, 90°]: latitude, planetocentric latitude or 90° · sine of either; in
/// [-180°, 180°] for web_mercator.
/// Computed with atan2, accurate at the poles; NaN in gives NaN out.
[[nodiscard]] double row_latitude_deg(const TileGrid& grid, const Ellipsoid& ellipsoid, const EcefDir& normal);
/// The inverse: geodetic latitude of a row latitude, which is clamped to its range.
[[nodiscard]] Angle latitude_of_row(const TileGrid& grid, const Ellipsoid& ellipsoid, double row_latitude_deg);

/// Continuous tile coordinates of (row latitude, longitude) at a level; longitude is not wrapped.
[[nodiscard]] TileXY tile_xy(const TileGrid& grid, int level, double row_latitude_deg, double lon_deg);
/// Row-latitude and longitude bounds of a tile, degrees, before clipping to the planet.
struct TileBounds {
  double west_deg, south_deg, east_deg, north_deg;
};
[[nodiscard]] TileBounds tile_bounds(const TileGrid& grid, const TileId& id);

}  // namespace terrella
