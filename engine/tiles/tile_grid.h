#pragma once

#include <compare>
#include <cstdint>
#include <optional>
#include <utility>

#include "geo/coordinates.h"
#include "geo/ellipsoid.h"

// thread: any, for all of this header
// Paper 1: A. Zuev, "Method of synthesis of a seamless textured sphere for visualization in geoinformation and
// cartographic systems", 2023.
namespace terrella {

/// The relation between rows of the imagery and latitude. `equirectangular` is paper 1's formula (3), rows linear in
/// latitude. `equal_area` is its formula (4), Lambert's cylinder, rows linear in the sine. The paper swaps the two
/// names. `web_mercator` is EPSG:3857's square, rows linear in asinh(tan(latitude)). It describes tiles as stored:
/// streaming/warp converts them to equirectangular ones, and web_mercator itself is never drawn. `projected` also
/// describes tiles as stored, and is never drawn: a square of any coordinate reference system (TileSetInfo::square).
enum class Projection { equirectangular, equal_area, web_mercator, projected };

/// Northern end of the square of Web Mercator: atan(sinh(π)), degrees.
inline constexpr double kMercatorEndDeg = 85.05112877980659;
/// Returns the row of Web Mercator of a latitude in [-90°, 90°]: -180 at the square's southern end and beyond, 180 at
/// its northern end and beyond. EPSG guidance note 7-2, 3.2.1.2 ("Popular Visualisation Pseudo Mercator").
[[nodiscard]] double mercator_row_deg(double latitude_deg);
/// Returns the latitude of a row of Web Mercator, in [-kMercatorEndDeg, kMercatorEndDeg].
[[nodiscard]] double latitude_of_mercator_row_deg(double row_deg);

/// The latitude that rows count: `graphic` geodetic (planetographic), `centric` planetocentric.
enum class LatitudeKind { graphic, centric };

/// A tile of a grid: level, column from the west, row from the NORTH. Sources convert other row orders. A squeezed tile
/// of a reduced row spans 2^squeeze columns, and x counts these wide columns.
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

/// A quadtree grid over longitude and latitude, clipped to the planet (engine/DESIGN.md, 4). Its origin, the outer
/// corner of tile (0, 0) of every level, is the planet's corner (-180°, +90°), or a place up to one root tile
/// north-west of it. Such an origin lets the pixels of a region be texels without resampling. Rows are measured in
/// degrees of "row latitude". In an equal_area grid one degree is 1/180 of the picture's height. In a web_mercator grid
/// it is 1/360: rows run from +180 to -180, and the origin is (-180°, +180). In a projected grid columns and rows both
/// run over the stored square, from -180 to 180 and from 180 to -180: a "degree" is 1/360 of its side. The functions of
/// this header are pure. thread: any
struct TileGrid {
  double root_span_deg = 180.0;  ///< span of a level-0 tile, degrees, in both directions; [1e-3, 1e4]
  int tile_px = 256;             ///< pixels per side, [16, 4096]
  int min_level = 0;             ///< [0, max_level]
  int max_level = 0;             ///< [min_level, kMaxTileLevel]
  Projection projection = Projection::equirectangular;
  LatitudeKind latitude = LatitudeKind::graphic;
  /// Area with data, in row latitude (web_mercator: latitude), south < north, west other than east; by default the
  /// whole planet.
  GeoRect bounds{};
  bool reduced = false;      ///< true if rows near the poles also have squeezed tiles (squeeze_of_row())
  double west_deg = -180.0;  ///< longitude of the origin; other than -180 only if the bounds do not cross ±180°
  double north_deg = 90.0;   ///< row latitude of the origin; web_mercator does not use the origin
  bool operator==(const TileGrid&) const = default;
};

/// Continuous tile coordinates at a level, in tiles: x east and y south from the grid's origin.
struct TileXY {
  double x;
  double y;
};

[[nodiscard]] double tile_span_deg(const TileGrid& grid, int level);  ///< root_span / 2^level
/// Row latitude of the grid's origin: north_deg, for web_mercator and projected 180.
[[nodiscard]] double top_row_deg(const TileGrid& grid);
/// Row latitude of the planet's southern end: -90, for web_mercator and projected -180.
[[nodiscard]] double bottom_row_deg(const TileGrid& grid);
/// True if the grid's origin is the planet's corner.
[[nodiscard]] bool begins_at_planet(const TileGrid& grid);
struct RowLatitudes {
  double south_deg, north_deg;
};
[[nodiscard]] RowLatitudes row_bounds(const TileGrid& grid);  ///< bounds in row latitude, for every projection
/// Matrix size. A strip under 1e-6 of a tile of the finest level counts as rounding and gets no tile. Levels are
/// counted from the finest, so the parent of every existing tile exists, down to min_level.
[[nodiscard]] std::int64_t columns(const TileGrid& grid, int level);  ///< tiles from the origin to 180°, ≥ 1
/// Number of tiles of a row that is squeezed by 2^squeeze.
[[nodiscard]] std::int64_t squeezed_columns(const TileGrid& grid, int level, int squeeze);
[[nodiscard]] std::int64_t rows(const TileGrid& grid, int level);  ///< tiles from the origin to -90°, ≥ 1
/// Returns the squeeze of a row in a reduced grid, a layout known from weather models: the largest k that keeps texels
/// short enough. Texels 2^k times as wide must be at most 20 % longer along the parallel than along the meridian, at
/// the row's edge nearest to the equator (engine/DESIGN.md, 12). 0 for other rows, for grids that are not reduced, and
/// for equal-area rows.
[[nodiscard]] int squeeze_of_row(const TileGrid& grid, int level, std::int64_t y);
/// Returns the tile to use for a tile of the full grid: in a reduced row the squeezed tile over it, else the tile
/// itself.
[[nodiscard]] TileId reduced_tile(const TileGrid& grid, const TileId& full);
/// True if the tile lies on the planet and in the level range, and touches the bounds.
[[nodiscard]] bool exists(const TileGrid& grid, const TileId& id);
[[nodiscard]] TileId parent(const TileId& id);  ///< for a full tile with id.level ≥ 1
/// Returns the ancestor of a full tile, `steps` levels up.
[[nodiscard]] TileId ancestor(const TileId& id, int steps);

/// Row latitude of a geodetic normal, in [-90°, 90°]: latitude, planetocentric latitude, or 90° · sine of either. In
/// [-180°, 180°] for web_mercator. Computed with atan2, accurate at the poles. NaN gives NaN.
[[nodiscard]] double row_latitude_deg(const TileGrid& grid, const Ellipsoid& ellipsoid, const EcefDir& normal);
/// Returns the geodetic latitude of a row latitude, which is clamped to its range.
[[nodiscard]] Angle latitude_of_row(const TileGrid& grid, const Ellipsoid& ellipsoid, double row_latitude_deg);

/// Continuous tile coordinates of (row latitude, longitude) at a level. The longitude is not wrapped.
[[nodiscard]] TileXY tile_xy(const TileGrid& grid, int level, double row_latitude_deg, double lon_deg);
/// Bounds of a tile in row latitude and longitude, degrees, before clipping to the planet.
struct TileBounds {
  double west_deg, south_deg, east_deg, north_deg;
};
[[nodiscard]] TileBounds tile_bounds(const TileGrid& grid, const TileId& id);

}  // namespace terrella
