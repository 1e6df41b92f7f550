#include "streaming/mercator/mercator_grid.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace terrella {
namespace {

double cosine_of(double latitude_deg) { return std::cos(Angle::degrees(latitude_deg).rad()); }

/// A finer level is not used for a shortfall below this fraction of a level.
constexpr double kLevelSlack = 0.02;

int stored_level(const TileGrid& mercator, const TileId& id, double north_deg, double south_deg) {
  const double nearest = north_deg < 0.0 ? -north_deg : std::max(south_deg, 0.0);
  const double level = id.level + std::log2(std::max(cosine_of(std::min(nearest, kMercatorEndDeg)), 1e-3));
  return std::clamp(static_cast<int>(std::ceil(level - kLevelSlack)), mercator.min_level,
                    std::min(mercator.max_level, id.level));
}

struct Range {
  std::int64_t first = 0;
  std::int64_t last = -1;
  void widen(std::int64_t from, std::int64_t to) {
    const bool none = last < first;
    first = none ? from : std::min(first, from);
    last = none ? to : std::max(last, to);
  }
  [[nodiscard]] bool meets(std::int64_t from, std::int64_t to) const { return first <= to && last >= from; }
};

void widen_by(Range& range, const Taps& taps) {
  if (taps.weights.empty()) return;
  range.widen(taps.first, taps.first + static_cast<std::int64_t>(taps.weights.size()) - 1);
}

std::int64_t tile_of(std::int64_t texel, std::int64_t tile_px) {
  return (texel >= 0 ? texel : texel - tile_px + 1) / tile_px;
}

/// Source texels under the tile's own area.
Range area(double first, double last) {
  constexpr double kSliver = 1e-6;
  return {static_cast<std::int64_t>(std::floor(first + kSliver)),
          static_cast<std::int64_t>(std::ceil(last - kSliver)) - 1};
}

struct Texels {
  Range columns, rows;
};

void add_pieces(const TileGrid& mercator, const Texels& read, const Texels& core, MercatorPlan& plan) {
  const std::int64_t px = plan.tile_px;
  const std::int64_t around = columns(mercator, plan.level);
  for (std::int64_t y = tile_of(read.rows.first, px); y <= tile_of(read.rows.last, px); ++y) {
    for (std::int64_t x = tile_of(read.columns.first, px); x <= tile_of(read.columns.last, px); ++x) {
      const TileId id{plan.level, ((x % around) + around) % around, y};
      if (!exists(mercator, id)) continue;
      const bool is_core = core.columns.meets(x * px, (x + 1) * px - 1) && core.rows.meets(y * px, (y + 1) * px - 1);
      plan.pieces.push_back({id, x * px - read.columns.first, y * px - read.rows.first, is_core});
    }
  }
}

}  // namespace

TileGrid geodetic_grid_of(const TileGrid& mercator) {
  assert(mercator.projection == Projection::web_mercator);
  TileGrid grid = mercator;
  grid.projection = Projection::equirectangular;
  const auto within = [](Angle side) {
    return Angle::degrees(std::clamp(side.deg(), -kMercatorEndDeg, kMercatorEndDeg));
  };
  grid.bounds.south = within(mercator.bounds.south);
  grid.bounds.north = within(mercator.bounds.north);
  const double farthest = std::max(std::abs(grid.bounds.south.deg()), std::abs(grid.bounds.north.deg()));
  const int further = static_cast<int>(std::floor(-std::log2(cosine_of(farthest)) + kLevelSlack));
  grid.max_level = std::min(mercator.max_level + std::max(further, 0), kMaxTileLevel);
  return grid;
}

MercatorPlan plan_tile(const TileGrid& mercator, const TileId& geodetic) {
  const TileGrid grid = geodetic_grid_of(mercator);
  const TileBounds bounds = tile_bounds(grid, geodetic);
  MercatorPlan plan{.tile_px = mercator.tile_px, .pieces = {}, .column_taps = {}, .row_taps = {}};
  plan.level = stored_level(mercator, geodetic, bounds.north_deg, bounds.south_deg);
  const double texels = std::ldexp(1.0, plan.level - geodetic.level);
  const double west = static_cast<double>(geodetic.x) * mercator.tile_px * texels;
  const double source_rows = 360.0 / tile_span_deg(mercator, plan.level) * mercator.tile_px;
  plan.column_taps = column_taps(west, texels, mercator.tile_px);
  plan.row_taps = row_taps(bounds.north_deg, bounds.north_deg - bounds.south_deg, mercator.tile_px, source_rows);

  Texels read;
  for (const Taps& taps : plan.column_taps) widen_by(read.columns, taps);
  for (const RowTaps& row : plan.row_taps) widen_by(read.rows, row.taps);
  if (read.rows.last < read.rows.first) return plan;
  const auto source_row = [&](double latitude_deg) {
    return (180.0 - mercator_row_deg(latitude_deg)) / 360.0 * source_rows;
  };
  const Texels core{area(west, west + mercator.tile_px * texels),
                    area(source_row(bounds.north_deg), source_row(bounds.south_deg))};
  add_pieces(mercator, read, core, plan);
  plan.columns = read.columns.last - read.columns.first + 1;
  plan.rows = read.rows.last - read.rows.first + 1;
  for (Taps& taps : plan.column_taps) taps.first -= read.columns.first;
  for (RowTaps& row : plan.row_taps) row.taps.first -= read.rows.first;
  return plan;
}

}  // namespace terrella
