#include "surface/height_field.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace terrella {
namespace {

/// A part of a pixel that is rounding of degrees.
constexpr double kPixelNoise = 1e-6;
/// What rounding may move a point over a box's border; 0.1 mm on Earth.
constexpr double kBoxNoiseDeg = 1e-9;

std::int64_t whole(double value) { return static_cast<std::int64_t>(std::floor(value)); }

/// Pixels that reach over an extent of so many pixels.
std::int64_t pixels_over(double extent_px) { return static_cast<std::int64_t>(std::ceil(extent_px - kPixelNoise)); }

double mix(double a, double b, double share) { return a * (1.0 - share) + b * share; }

/// Longitude in [-180°, 180°).
double wrapped_lon_deg(double lon_deg) {
  const double east = std::fmod(lon_deg + 180.0, 360.0);
  return (east < 0.0 ? east + 360.0 : east) - 180.0;
}

}  // namespace

struct HeightField::Extrema {
  double least = std::numeric_limits<double>::infinity();
  double most = -std::numeric_limits<double>::infinity();

  void add(double least_m, double most_m) {
    least = std::min(least, least_m);
    most = std::max(most, most_m);
  }
};

HeightField::HeightField(const Ellipsoid& ellipsoid, const TileGrid& grid) : ellipsoid_(ellipsoid), grid_(grid) {
  for (int level = 0; level <= grid.max_level; ++level) {
    LevelSize& size = sizes_[static_cast<std::size_t>(level)];
    size.span_deg = tile_span_deg(grid, level);
    size.turn_px = (180.0 - grid.west_deg) * grid.tile_px / size.span_deg;
    size.columns = columns(grid, level);
    size.rows = rows(grid, level);
    size.last_pixel_row = pixels_over((top_row_deg(grid) + 90.0) * grid.tile_px / size.span_deg) - 1;
  }
}

// ---- what is there

void HeightField::add(HeightTile tile) {
  assert(exists(grid_, tile.id) && tile.side_px == grid_.tile_px);
  assert(tile.heights_m.size() == static_cast<std::size_t>(tile.side_px) * static_cast<std::size_t>(tile.side_px));
  remove(tile.id);
  Held held{.tile = std::move(tile), .blocks = (grid_.tile_px + kBlock_px - 1) / kBlock_px, .extrema = {}};
  constexpr double kNone = std::numeric_limits<double>::infinity();
  const auto blocks = static_cast<std::size_t>(held.blocks);
  const auto side = static_cast<std::size_t>(grid_.tile_px);
  held.extrema.assign(blocks * blocks, GroundRange{.min_m = kNone, .max_m = -kNone});
  for (std::size_t i = 0; i < side * side; ++i) {
    GroundRange& block = held.extrema[i / side / kBlock_px * blocks + i % side / kBlock_px];
    const auto height_m = static_cast<double>(held.tile.heights_m[i]);
    block.min_m = std::min(block.min_m, height_m);
    block.max_m = std::max(block.max_m, height_m);
  }
  const TileId id = held.tile.id;
  held.own_columns = std::min<std::int64_t>(grid_.tile_px, pixels_over(turn_px(id.level)) - id.x * grid_.tile_px);
  held.own_rows = std::min<std::int64_t>(grid_.tile_px, size_of(id.level).last_pixel_row + 1 - id.y * grid_.tile_px);
  tiles_.insert_or_assign(id, std::move(held));
  for (int up = 1; up <= id.level; ++up) ++below_[ancestor(id, up)];
  ++of_level_[static_cast<std::size_t>(id.level)];
  ++version_;
}

void HeightField::remove(const TileId& id) {
  if (tiles_.erase(id) == 0) return;
  for (int up = 1; up <= id.level; ++up) {
    const auto counted = below_.find(ancestor(id, up));
    if (--counted->second == 0) below_.erase(counted);
  }
  --of_level_[static_cast<std::size_t>(id.level)];
  ++version_;
}

const HeightField::Held* HeightField::find(const TileId& id) const {
  const auto found = tiles_.find(id);
  return found == tiles_.end() ? nullptr : &found->second;
}

const HeightField::Held* HeightField::finest_at(double row_latitude_deg, double lon_deg) const {
  for (int level = grid_.max_level; level >= grid_.min_level; --level) {
    if (of_level_[static_cast<std::size_t>(level)] == 0) continue;
    if (const Held* held = find(tile_at(level, row_latitude_deg, lon_deg))) return held;
  }
  return nullptr;
}

/// The south pole, and what rounding lets stand on the last border, belong to the last row and column.
TileId HeightField::tile_at(int level, double row_latitude_deg, double lon_deg) const {
  const LevelSize& size = size_of(level);
  return {
      .level = level,
      .x = std::clamp<std::int64_t>(whole((lon_deg - grid_.west_deg) / size.span_deg), 0, size.columns - 1),
      .y = std::clamp<std::int64_t>(whole((top_row_deg(grid_) - row_latitude_deg) / size.span_deg), 0, size.rows - 1)};
}

// ---- heights

double HeightField::row_deg(Angle lat) const {
  if (grid_.projection == Projection::equirectangular && grid_.latitude == LatitudeKind::graphic) return lat.deg();
  return row_latitude_deg(grid_, ellipsoid_, Ellipsoid::normal(lat, Angle{}));
}

double HeightField::height_m(Angle lat, Angle lon, double exaggeration) const {
  return exaggeration * height_at_row_m(row_deg(lat), lon.deg());
}

double HeightField::height_at_row_m(double row_latitude_deg, double lon_deg) const {
  return Cursor(*this).height_at_row_m(row_latitude_deg, lon_deg);
}

void HeightField::Cursor::find_tile(double row_latitude_deg, double lon_deg) {
  if (own_ != nullptr && finest_) {
    const TileId& id = own_->tile.id;
    if (field_.tile_at(id.level, row_latitude_deg, lon_deg) == id) return;
  }
  own_ = field_.finest_at(row_latitude_deg, lon_deg);
  finest_ = own_ != nullptr && !field_.below_.contains(own_->tile.id);
}

double HeightField::Cursor::height_at_row_m(double row_latitude_deg, double lon_deg) {
  const double lon = wrapped_lon_deg(lon_deg);
  if (std::isnan(lon) || std::isnan(row_latitude_deg)) return 0.0;
  find_tile(row_latitude_deg, lon);
  if (own_ == nullptr) return 0.0;
  const TileId& id = own_->tile.id;
  const std::int64_t side = own_->tile.side_px;
  const double span_deg = field_.size_of(id.level).span_deg;
  const double x = (lon - field_.grid_.west_deg) / span_deg * static_cast<double>(side) - 0.5;
  const double y = (top_row_deg(field_.grid_) - row_latitude_deg) / span_deg * static_cast<double>(side) - 0.5;
  const std::int64_t x0 = whole(x), y0 = whole(y);
  const double east = x - static_cast<double>(x0), south = y - static_cast<double>(y0);
  const std::int64_t column = x0 - id.x * side, row = y0 - id.y * side;
  if (column >= 0 && row >= 0 && column + 1 < own_->own_columns && row + 1 < own_->own_rows) {
    const float* north = own_->tile.heights_m.data() + row * side + column;
    return mix(mix(double{north[0]}, double{north[1]}, east), mix(double{north[side]}, double{north[side + 1]}, east),
               south);
  }
  return mix(mix(field_.pixel(*own_, x0, y0), field_.pixel(*own_, x0 + 1, y0), east),
             mix(field_.pixel(*own_, x0, y0 + 1), field_.pixel(*own_, x0 + 1, y0 + 1), east), south);
}

double HeightField::Cursor::spacing_m() const {
  const int level = own_ != nullptr ? own_->tile.id.level : field_.grid_.min_level;
  const double pixel_deg = field_.size_of(level).span_deg / field_.grid_.tile_px;
  return Angle::degrees(pixel_deg).rad() * field_.ellipsoid_.a_m();
}

/// Any pixel around a point of `own`: beyond a pole the last row.
double HeightField::pixel(const Held& own, std::int64_t x, std::int64_t y) const {
  return pixel_round_planet(own, x, std::clamp<std::int64_t>(y, 0, size_of(own.tile.id.level).last_pixel_row));
}

/// Where 360° are no whole number of pixels, a column beyond ±180° lies between two that are there. A grid with an
/// origin of its own does not go round the planet.
double HeightField::pixel_round_planet(const Held& own, std::int64_t x, std::int64_t y) const {
  const double turn = turn_px(own.tile.id.level);
  if (x >= 0 && x < pixels_over(turn)) return pixel_in_tiles(own, x, y);
  if (grid_.west_deg != -180.0) return pixel_in_tiles(own, x < 0 ? 0 : pixels_over(turn) - 1, y);
  const double column = static_cast<double>(x) + (x < 0 ? turn : -turn);
  const std::int64_t first = whole(column + kPixelNoise);
  const double share = std::max(0.0, column - static_cast<double>(first));
  const double height = pixel_in_tiles(own, first, y);
  return share < kPixelNoise ? height : mix(height, pixel_in_tiles(own, first + 1, y), share);
}

double HeightField::pixel_in_tiles(const Held& own, std::int64_t x, std::int64_t y) const {
  const TileId& id = own.tile.id;
  const std::int64_t side = grid_.tile_px;
  const TileId at{.level = id.level, .x = x / side, .y = y / side};
  const Held* held = at == id ? &own : find(at);
  const auto value = [side](const Held& tile, std::int64_t column, std::int64_t row) {
    return static_cast<double>(tile.tile.heights_m[static_cast<std::size_t>(row * side + column)]);
  };
  if (held != nullptr) return value(*held, x % side, y % side);
  // The nearer border, also round the planet.
  const auto turn = static_cast<std::int64_t>(std::llround(turn_px(id.level)));
  const auto beyond = [side](std::int64_t column) { return std::max({-column, column - (side - 1), std::int64_t{0}}); };
  std::int64_t column = x - id.x * side;
  for (const std::int64_t around : {column - turn, column + turn}) {
    if (beyond(around) < beyond(column)) column = around;
  }
  return value(own, std::clamp<std::int64_t>(column, 0, side - 1),
               std::clamp<std::int64_t>(y - id.y * side, 0, side - 1));
}

// ---- ranges

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
  // A point at +180° is one at -180°, and what rounding moves over it comes out at the other side.
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

/// Widens by what serves the part of the box in this place: the finer tiles, and the tile itself where one of them is
/// not there. False: an ancestor has to serve, a part at least.
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
  // Half a pixel to the middles around, and what rounding may move.
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
