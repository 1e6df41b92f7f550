#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "geo/ellipsoid.h"
#include "geo/height_tile.h"
#include "geo/tile_grid.h"
#include "scene/patch_tree.h"

namespace terrella {

/// Heights between which something lies, metres.
struct GroundRange {
  double min_m = 0.0;
  double max_m = 0.0;
};

/// The heights of a body as far as their tiles are there. A height belongs to its pixel's middle; between the middles
/// of four pixels it is bilinear in longitude and row latitude (TileGrid). Pixels go on round ±180°; beyond a pole the
/// last row repeats. A point takes the finest tile that is there and covers it; pixels beyond that tile's border are
/// those of its neighbours of the same level, and where such a neighbour is not there the border's own once more. So
/// heights are continuous but where levels meet. Where no tile is the height is 0.
/// thread: main
class HeightField {
 public:
  HeightField(const Ellipsoid& ellipsoid, const TileGrid& grid) : ellipsoid_(ellipsoid), grid_(grid) {}

  [[nodiscard]] const TileGrid& grid() const { return grid_; }
  /// A tile that exists in the grid, of its size; replaces the one that was there.
  void add(HeightTile tile);
  void remove(const TileId& id);  ///< nothing if it is not there
  [[nodiscard]] bool has(const TileId& id) const { return tiles_.contains(id); }
  [[nodiscard]] std::size_t size() const { return tiles_.size(); }
  /// Changes with each add() and remove(): what was worked out under another number is out of date.
  [[nodiscard]] std::uint64_t version() const { return version_; }

  /// Metres times `exaggeration`. Longitude may be any turn; NaN gives 0.
  [[nodiscard]] double height_m(Angle lat, Angle lon, double exaggeration = 1.0) const;
  /// The same by the row latitude of grid(), degrees.
  [[nodiscard]] double height_at_row_m(double row_latitude_deg, double lon_deg) const;

  /// No height in the box lies outside, rounding (1 part in 10^12) aside; the pixels that bound it may lie a block
  /// (kBlock_px) beyond the box. East < west crosses ±180°.
  [[nodiscard]] GroundRange range_m(const GeoRect& box, double exaggeration = 1.0) const;
  /// Of a patch of that tree, whose rows may count otherwise than grid()'s.
  [[nodiscard]] GroundRange range_m(const PatchTree& tree, const PatchNode& node, double exaggeration = 1.0) const;

 private:
  static constexpr int kBlock_px = 16;
  struct Held {
    HeightTile tile;
    int blocks = 0;                    ///< a side
    std::vector<GroundRange> extrema;  ///< of kBlock_px² pixels each, row-major
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
  [[nodiscard]] const Held* finest_at(double row_latitude_deg, double lon_deg) const;
  [[nodiscard]] double turn_px(int level) const { return 360.0 * grid_.tile_px / tile_span_deg(grid_, level); }
  [[nodiscard]] double pixel(const Held& own, std::int64_t x, std::int64_t y) const;
  [[nodiscard]] double pixel_round_planet(const Held& own, std::int64_t x, std::int64_t y) const;
  [[nodiscard]] double pixel_in_tiles(const Held& own, std::int64_t x, std::int64_t y) const;

  [[nodiscard]] GroundRange range_of_rows(const GeoRect& rows, double exaggeration) const;
  void widen_by_box(const RowBox& box, Extrema& extrema) const;
  [[nodiscard]] bool touches(const TileId& id, const RowBox& box) const;
  [[nodiscard]] bool served(const TileId& id, const RowBox& box, Extrema& extrema) const;
  void widen_by_pixels(int level, const PixelBox& pixels, Extrema& extrema) const;
  static void widen_by_blocks(const Held& held, const PixelBox& in_tile, Extrema& extrema);

  Ellipsoid ellipsoid_;
  TileGrid grid_;
  std::unordered_map<TileId, Held, TileIdHash> tiles_;
  std::unordered_map<TileId, int, TileIdHash> below_;  ///< how many finer tiles are there under a place
  std::array<int, kMaxTileLevel + 1> of_level_{};
  std::uint64_t version_ = 0;
};

}  // namespace terrella
