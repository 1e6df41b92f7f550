#include "surface/height_field.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "surface/height_pixels.h"

namespace terrella {
namespace {

double mix(double a, double b, double share) { return a * (1.0 - share) + b * share; }

}  // namespace

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

// ---- tiles

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

/// The south pole and points on the last border belong to the last row and column.
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

/// If 360° are no whole number of pixels, a column beyond ±180° lies between two columns of the grid. A grid with an
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

}  // namespace terrella
