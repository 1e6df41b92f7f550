#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <unordered_map>
#include <vector>

#include "geo/ellipsoid.h"
#include "surface/patch_tree.h"
#include "tiles/height_tile.h"
#include "tiles/tile_grid.h"

namespace terrella {

/// Lowest and highest height of an area, metres.
struct GroundRange {
  double min_m = 0.0;
  double max_m = 0.0;
};

/// The heights of a body in the loaded tiles. A height belongs to its pixel's middle. Between the middles of four
/// pixels it is bilinear in longitude and row latitude (TileGrid). Pixels continue across ±180°, and the last row
/// repeats beyond a pole. A point takes its height from the finest loaded tile over it. Beyond that tile's border the
/// neighbours of the same level have the pixels; if a neighbour is not loaded, the border repeats. So heights are
/// continuous except between levels. Without a tile the height is 0. thread: main; const functions: any, while nothing
/// changes the field
class HeightField {
 public:
  class Cursor;

  HeightField(const Ellipsoid& ellipsoid, const TileGrid& grid);

  [[nodiscard]] const TileGrid& grid() const { return grid_; }
  /// Adds a tile of the grid, of the grid's tile size. Replaces an earlier tile of the same id.
  void add(HeightTile tile);
  void remove(const TileId& id);  ///< does nothing if the tile is not loaded
  [[nodiscard]] bool has(const TileId& id) const { return tiles_.contains(id); }
  [[nodiscard]] std::size_t size() const { return tiles_.size(); }
  /// Changes with each add() and remove(). Results computed under another number are out of date.
  [[nodiscard]] std::uint64_t version() const { return version_; }

  /// Row latitude of the geodetic latitude `lat`, degrees.
  [[nodiscard]] double row_deg(Angle lat) const;
  /// Returns the height at a place, metres times `exaggeration`. Longitude may be any turn; NaN gives 0.
  [[nodiscard]] double height_m(Angle lat, Angle lon, double exaggeration = 1.0) const;
  /// Returns the height at a row latitude of grid(), degrees.
  [[nodiscard]] double height_at_row_m(double row_latitude_deg, double lon_deg) const;
  /// Slopes at the pixel middles of a tile and of `border_px` around it: rise per metre towards east and north.
  /// Row-major from the north-west, (tile_px + 2 · border_px)². A slope is the difference over four pixels, of fourth
  /// order. Pixels beyond the tile are those of the field there. A tile that is not loaded, or finer than the grid's
  /// finest level, takes its slopes from its nearest loaded ancestor by a cubic B-spline, so that they bend evenly. 0
  /// if there is none.
  [[nodiscard]] std::vector<glm::vec2> slopes(const TileId& id, int border_px) const;

  /// Returns a range that holds all heights in the box, rounding (1 part in 10^12) aside. The pixels that bound the
  /// range may lie a block (kBlock_px) beyond the box. East < west crosses ±180°.
  [[nodiscard]] GroundRange range_m(const GeoRect& box, double exaggeration = 1.0) const;
  /// Range of a patch of that tree, whose rows may count another latitude than grid()'s.
  [[nodiscard]] GroundRange range_m(const PatchTree& tree, const PatchNode& node, double exaggeration = 1.0) const;

 private:
  static constexpr int kBlock_px = 16;
  struct Held {
    HeightTile tile;
    int blocks = 0;                    ///< a side
    std::vector<GroundRange> extrema;  ///< ranges of blocks of kBlock_px² pixels, row-major
    /// Columns and rows of the tile, from its north-west corner, that lie on the planet: beyond them pixels come from
    /// elsewhere.
    std::int64_t own_columns = 0, own_rows = 0;
  };
  /// Values of a level, computed once.
  struct LevelSize {
    double span_deg = 0.0;  ///< side of a tile
    double turn_px = 0.0;   ///< from the origin to 180°: 360° or more, no whole number in some grids
    std::int64_t columns = 0, rows = 0;
    std::int64_t last_pixel_row = 0;
  };
  /// Pixels of a level, columns and rows from the grid's north-west corner, last ones included.
  struct PixelBox {
    std::int64_t x0, y0, x1, y1;
  };
  /// Row latitudes and longitudes, degrees, west < east, within [-180°, 180°].
  struct RowBox {
    double west, south, east, north;
  };
  struct Extrema;

  [[nodiscard]] const Held* find(const TileId& id) const;
  [[nodiscard]] TileId tile_at(int level, double row_latitude_deg, double lon_deg) const;
  [[nodiscard]] const Held* finest_at(double row_latitude_deg, double lon_deg) const;
  [[nodiscard]] const LevelSize& size_of(int level) const { return sizes_[static_cast<std::size_t>(level)]; }
  [[nodiscard]] double turn_px(int level) const { return size_of(level).turn_px; }
  [[nodiscard]] double pixel(const Held& own, std::int64_t x, std::int64_t y) const;
  [[nodiscard]] double pixel_round_planet(const Held& own, std::int64_t x, std::int64_t y) const;
  [[nodiscard]] double pixel_in_tiles(const Held& own, std::int64_t x, std::int64_t y) const;

  /// A rectangle of pixels of a tile, and around it.
  struct PixelRect {
    std::int64_t x0, y0, width, height;
  };
  [[nodiscard]] std::vector<glm::vec2> slopes_within(const TileId& id, const PixelRect& rect) const;
  [[nodiscard]] std::vector<glm::vec2> finer_slopes(const TileId& id, const TileId& loaded, int border_px) const;

  [[nodiscard]] GroundRange range_of_rows(const GeoRect& rows, double exaggeration) const;
  void widen_by_box(const RowBox& box, Extrema& extrema) const;
  [[nodiscard]] bool touches(const TileId& id, const RowBox& box) const;
  [[nodiscard]] bool served(const TileId& id, const RowBox& box, Extrema& extrema) const;
  void widen_by_pixels(int level, const PixelBox& pixels, Extrema& extrema) const;
  static void widen_by_blocks(const Held& held, const PixelBox& in_tile, Extrema& extrema);

  Ellipsoid ellipsoid_;
  TileGrid grid_;
  std::array<LevelSize, kMaxTileLevel + 1> sizes_{};
  std::unordered_map<TileId, Held, TileIdHash> tiles_;
  std::unordered_map<TileId, int, TileIdHash> below_;  ///< number of loaded finer tiles under a place
  std::array<int, kMaxTileLevel + 1> of_level_{};
  std::uint64_t version_ = 0;
};

/// Lookups that lie near one another: tries the tile of the last lookup first. Returns the same bits as the field. Not
/// valid after the field has changed. thread: any, one at a time
class HeightField::Cursor {
 public:
  explicit Cursor(const HeightField& field) : field_(field) {}
  [[nodiscard]] double height_at_row_m(double row_latitude_deg, double lon_deg);
  [[nodiscard]] double row_deg(Angle lat) const { return field_.row_deg(lat); }
  /// Spacing of the heights of the last lookup, metres along a meridian at the equator; before any, the coarsest
  /// level's.
  [[nodiscard]] double spacing_m() const;

 private:
  void find_tile(double row_latitude_deg, double lon_deg);

  const HeightField& field_;
  const Held* own_ = nullptr;
  bool finest_ = false;  ///< no finer tile lies under own_
};

}  // namespace terrella
