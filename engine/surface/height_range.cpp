#include <algorithm>
#include <limits>

#include "surface/height_field.h"
#include "surface/height_pixels.h"

// Ranges of heights in boxes and patches.
namespace terrella {
namespace {

// Rounding may move a point over a box's border by this; 0.1 mm on Earth.
constexpr double kBoxNoiseDeg = 1e-9;

}  // namespace

struct HeightField::Extrema {
  double least = std::numeric_limits<double>::infinity();
  double most = -std::numeric_limits<double>::infinity();

  void add(double least_m, double most_m) {
    least = std::min(least, least_m);
    most = std::max(most, most_m);
  }
};

GroundRange HeightField::range_m(const GeoRect& box, double exaggeration) const {
  const auto row_of = [this](Angle lat) {
    return Angle::degrees(row_latitude_deg(grid_, ellipsoid_, Ellipsoid::normal(lat, Angle::degrees(0.0))));
  };
  return range_of_rows({.west = box.west, .south = row_of(box.south), .east = box.east, .north = row_of(box.north)},
                       exaggeration);
}

GroundRange HeightField::range_m(const PatchTree& tree, const PatchNode& node, double exaggeration) const {
  const auto latitude = [&tree](double row_deg) { return latitude_of_row(tree.grid(), tree.ellipsoid(), row_deg); };
  const bool all_longitudes = node.east_deg - node.west_deg >= 360.0;
  const double west = all_longitudes ? -180.0 : wrapped_lon_deg(node.lon_center_deg + node.west_deg);
  const double east = all_longitudes ? 180.0 : wrapped_lon_deg(node.lon_center_deg + node.east_deg);
  return range_m({.west = Angle::degrees(west),
                  .south = latitude(node.south_row_deg),
                  .east = Angle::degrees(east),
                  .north = latitude(node.north_row_deg)},
                 exaggeration);
}

GroundRange HeightField::range_of_rows(const GeoRect& rows_box, double exaggeration) const {
  const double west = rows_box.west.deg();
  const double east = rows_box.east.deg();
  const double south = rows_box.south.deg() - kBoxNoiseDeg;
  const double north = rows_box.north.deg() + kBoxNoiseDeg;
  const bool crosses = west > east;
  Extrema extrema;
  widen_by_box({west - kBoxNoiseDeg, south, (crosses ? 180.0 : east) + kBoxNoiseDeg, north}, extrema);
  // A point at +180° is one at -180°: rounding may move it to the other side.
  if (crosses || east >= 180.0 - kBoxNoiseDeg) {
    widen_by_box({-180.0, south, (crosses ? east : -180.0) + kBoxNoiseDeg, north}, extrema);
  }
  if (west <= -180.0 + kBoxNoiseDeg) widen_by_box({180.0 - kBoxNoiseDeg, south, 180.0, north}, extrema);
  if (extrema.least > extrema.most) extrema.add(0.0, 0.0);
  const auto [least, most] = std::minmax({exaggeration * extrema.least, exaggeration * extrema.most});
  return {.min_m = least, .max_m = most};
}

/// The height is 0 if no tile is loaded.
void HeightField::widen_by_box(const RowBox& box, Extrema& extrema) const {
  for (std::int64_t y = 0; y < rows(grid_, 0); ++y) {
    for (std::int64_t x = 0; x < columns(grid_, 0); ++x) {
      const TileId root{.level = 0, .x = x, .y = y};
      if (touches(root, box) && !served(root, box, extrema)) extrema.add(0.0, 0.0);
    }
  }
}

/// True if the tile has points of the box on the planet.
bool HeightField::touches(const TileId& id, const RowBox& box) const {
  const TileBounds tile = tile_bounds(grid_, id);
  return tile.east_deg >= box.west && tile.west_deg <= box.east && tile.north_deg >= box.south &&
         tile.south_deg <= box.north && tile.west_deg < 180.0 && tile.north_deg > -90.0;
}

/// Widens by the tiles that give the heights of the box in this place: the finer tiles, and the tile itself if one of
/// them is not loaded. False if an ancestor gives some of the heights.
bool HeightField::served(const TileId& id, const RowBox& box, Extrema& extrema) const {
  bool by_finer = below_.contains(id);
  if (by_finer) {
    for (int child = 0; child < 4; ++child) {
      const TileId finer{.level = id.level + 1, .x = 2 * id.x + child % 2, .y = 2 * id.y + child / 2};
      if (touches(finer, box) && !served(finer, box, extrema)) by_finer = false;
    }
  }
  if (by_finer) return true;
  if (find(id) == nullptr) return false;
  const TileBounds tile = tile_bounds(grid_, id);
  const double west = std::max(box.west, tile.west_deg);
  const double east = std::min(box.east, tile.east_deg);
  const double north = std::min(box.north, tile.north_deg);
  const double south = std::max(box.south, tile.south_deg);
  const TileXY first = tile_xy(grid_, id.level, north, west);
  const TileXY last = tile_xy(grid_, id.level, south, east);
  const double side = grid_.tile_px;
  // Half a pixel to the middles around, and rounding.
  constexpr double kAround_px = 0.5 + 1e-3;
  widen_by_pixels(id.level,
                  {whole(first.x * side - kAround_px), whole(first.y * side - kAround_px),
                   whole(last.x * side + kAround_px), whole(last.y * side + kAround_px)},
                  extrema);
  return true;
}

/// All tiles of a level that hold some of the pixels, also those beyond ±180°.
void HeightField::widen_by_pixels(int level, const PixelBox& pixels, Extrema& extrema) const {
  const std::int64_t side = grid_.tile_px;
  const std::int64_t turn = pixels_over(turn_px(level));
  for (std::int64_t y = std::max<std::int64_t>(0, pixels.y0) / side; y <= std::max<std::int64_t>(0, pixels.y1) / side;
       ++y) {
    const auto widen = [&](std::int64_t x0, std::int64_t x1) {
      for (std::int64_t x = x0 / side; x <= x1 / side; ++x) {
        const Held* held = find({.level = level, .x = x, .y = y});
        if (held == nullptr) continue;
        widen_by_blocks(*held, {x0 - x * side, pixels.y0 - y * side, x1 - x * side, pixels.y1 - y * side}, extrema);
      }
    };
    widen(std::max<std::int64_t>(0, pixels.x0), std::min(pixels.x1, turn - 1));
    // A column beyond ±180° may lie between two.
    if (pixels.x0 < 0) widen(std::max<std::int64_t>(0, pixels.x0 + turn - 1), turn - 1);
    if (pixels.x1 >= turn) widen(0, std::min(pixels.x1 - turn + 1, turn - 1));
  }
}

void HeightField::widen_by_blocks(const Held& held, const PixelBox& in_tile, Extrema& extrema) {
  const auto block_of = [&held](std::int64_t px) {
    return std::clamp<std::int64_t>(px, 0, held.tile.side_px - 1) / kBlock_px;
  };
  for (std::int64_t y = block_of(in_tile.y0); y <= block_of(in_tile.y1); ++y) {
    for (std::int64_t x = block_of(in_tile.x0); x <= block_of(in_tile.x1); ++x) {
      const GroundRange& block = held.extrema[static_cast<std::size_t>(y * held.blocks + x)];
      extrema.add(block.min_m, block.max_m);
    }
  }
}

}  // namespace terrella
