#include "streaming/preload/block_walk.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "streaming/preload/projected_places.h"

namespace terrella {
namespace {

/// Overlaps below this fraction of a tile of the finest level are rounding errors, as for the grid itself
/// (tiles/tile_grid.h).
constexpr double kSliverTiles = 1.0e-6;

TileSpan meet(const TileSpan& a, const TileSpan& b) { return {std::max(a.first, b.first), std::min(a.last, b.last)}; }
MapRect meet(const MapRect& a, const MapRect& b) {
  return {.west_deg = std::max(a.west_deg, b.west_deg),
          .south_deg = std::max(a.south_deg, b.south_deg),
          .east_deg = std::min(a.east_deg, b.east_deg),
          .north_deg = std::min(a.north_deg, b.north_deg)};
}
MapRect around(const MapRect& a, const MapRect& b) {
  return {.west_deg = std::min(a.west_deg, b.west_deg),
          .south_deg = std::min(a.south_deg, b.south_deg),
          .east_deg = std::max(a.east_deg, b.east_deg),
          .north_deg = std::max(a.north_deg, b.north_deg)};
}
bool any(const TileSpan& span) { return span.first <= span.last; }
TileSpan side(std::int64_t number, int shift) { return {number << shift, ((number + 1) << shift) - 1}; }

}  // namespace

BlockWalk::BlockWalk(const TileGrid& grid, const Ellipsoid& ellipsoid, const Region& region, int level,
                     const ProjectedPlaces* projected, TileRule rule)
    : grid_(grid),
      ellipsoid_(ellipsoid),
      region_(region),
      level_(level),
      projected_(projected),
      rule_(rule),
      sliver_deg_(kSliverTiles * tile_span_deg(grid, grid.max_level)),
      places_(projected == nullptr ? tile_places(grid, level) : projected->places(level)) {
  const auto longest = static_cast<std::uint64_t>(std::max(columns(grid, level), rows(grid, level)));
  visit({static_cast<int>(std::bit_width(longest - 1)), 0, 0}, {.sight = region.whole()});
}

std::optional<TileBlock> BlockWalk::next() {
  while (ready_.empty()) {
    if (way_.empty()) return std::nullopt;
    Opened& top = way_.back();
    if (top.child == 4) {
      way_.pop_back();
      continue;
    }
    const int child = top.child++;
    const Node node{top.node.shift - 1, 2 * top.node.x + child / 2, 2 * top.node.y + child % 2};
    visit(node, top.view);
  }
  const TileBlock block = ready_.back();
  ready_.pop_back();
  return block;
}

void BlockWalk::visit(const Node& node, const View& outer) {
  if (!holds_places(node)) return;
  const Overlap overlap = overlap_of(node, outer);
  if (overlap == Overlap::outside) return;
  if (overlap == Overlap::inside || node.shift == 0) {
    if (overlap == Overlap::inside || rule_ == TileRule::overlapping) add_blocks(node);
    return;
  }
  way_.push_back({node, 0, seen_});
}

Overlap BlockWalk::overlap_of(const Node& node, const View& outer) {
  if (region_.empty()) return Overlap::inside;
  if (projected_ != nullptr) return projected_overlap_of(node, outer);
  return region_.classify(rect(node), outer.sight, seen_.sight);
}

Overlap BlockWalk::projected_overlap_of(const Node& node, const View& outer) {
  bool some = false, all = true;
  std::optional<MapRect> hull;
  for (const MapRect& rect : projected_->rects(level_, side(node.x, node.shift), side(node.y, node.shift))) {
    const MapRect part = meet(rect, outer.hull);
    if (!(part.west_deg < part.east_deg && part.south_deg < part.north_deg)) continue;
    const Overlap overlap = region_.classify(part, outer.sight, seen_.sight);
    some = some || overlap != Overlap::outside;
    all = all && overlap == Overlap::inside;
    hull = hull ? around(*hull, part) : part;
  }
  if (!some) return Overlap::outside;
  if (all) return Overlap::inside;
  seen_.hull = *hull;
  static_cast<void>(region_.classify(seen_.hull, outer.sight, seen_.sight));  // for its sight
  return Overlap::cut;
}

bool BlockWalk::holds_places(const Node& node) const {
  if (!any(meet(side(node.y, node.shift), places_.rows))) return false;
  return std::ranges::any_of(places_.columns,
                             [&](const TileSpan& span) { return any(meet(side(node.x, node.shift), span)); });
}

void BlockWalk::add_blocks(const Node& node) {
  const TileSpan rows = meet(side(node.y, node.shift), places_.rows);
  for (auto span = places_.columns.rbegin(); span != places_.columns.rend(); ++span) {
    const TileSpan columns = meet(side(node.x, node.shift), *span);
    if (any(columns)) ready_.push_back({columns, rows});
  }
}

MapRect BlockWalk::rect(const Node& node) const {
  const double span_deg = tile_span_deg(grid_, level_);
  const TileSpan columns = side(node.x, node.shift);
  const TileSpan rows = side(node.y, node.shift);
  const auto degrees = [&](std::int64_t tiles) { return static_cast<double>(tiles) * span_deg; };
  const double top = top_row_deg(grid_);
  const auto latitude = [&](double row_deg) { return latitude_of_row(grid_, ellipsoid_, row_deg).deg(); };
  return {.west_deg = std::max(-180.0, grid_.west_deg + degrees(columns.first)) + sliver_deg_,
          .south_deg = latitude(std::max(bottom_row_deg(grid_), top - degrees(rows.last + 1) + sliver_deg_)),
          .east_deg = std::min(180.0, grid_.west_deg + degrees(columns.last + 1) - sliver_deg_),
          .north_deg = latitude(top - degrees(rows.first) - sliver_deg_)};
}

}  // namespace terrella
