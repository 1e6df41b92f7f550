#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "geo/ellipsoid.h"
#include "streaming/preload/region.h"
#include "tiles/tile_grid.h"
#include "tiles/tile_range.h"

namespace terrella {

class ProjectedPlaces;

/// Tiles of one level: each of these columns in each of these rows.
struct TileBlock {
  TileSpan columns;
  TileSpan rows;
  [[nodiscard]] std::int64_t count() const { return (columns.last - columns.first + 1) * (rows.last - rows.first + 1); }
};

/// Tiles that belong to a region.
enum class TileRule {
  overlapping,
  inside,  ///< those that reach nowhere beyond it
};

/// Lists the tiles of a level that belong to a region, as blocks. Walks down a quadtree whose root covers the whole
/// level, and stores only the current path. Grid, ellipsoid and region must outlive the walk, as must `projected`, the
/// places of a `projected` grid; null for other grids. thread: one at a time
class BlockWalk {
 public:
  BlockWalk(const TileGrid& grid, const Ellipsoid& ellipsoid, const Region& region, int level,
            const ProjectedPlaces* projected = nullptr, TileRule rule = TileRule::overlapping);
  [[nodiscard]] std::optional<TileBlock> next();

 private:
  struct Node {
    int shift;  ///< 2^shift tiles a side
    std::int64_t x, y;
  };
  /// The region as a node sees it.
  struct View {
    Region::Sight sight;
    /// For a `projected` grid: the rectangle around all rectangles of the node, whose sight it is. Those of its
    /// children are cut to it.
    MapRect hull{.west_deg = -180.0, .south_deg = -90.0, .east_deg = 180.0, .north_deg = 90.0};
  };
  struct Opened {
    Node node;
    int child = 0;  ///< index of the next child to visit
    View view;
  };
  /// Opens a node so that its children are visited next, or puts its blocks, if any, into `ready_`.
  void visit(const Node& node, const View& outer);
  void add_blocks(const Node& node);
  [[nodiscard]] bool holds_places(const Node& node) const;
  [[nodiscard]] MapRect rect(const Node& node) const;
  [[nodiscard]] Overlap overlap_of(const Node& node, const View& outer);
  [[nodiscard]] Overlap projected_overlap_of(const Node& node, const View& outer);

  const TileGrid& grid_;
  const Ellipsoid& ellipsoid_;
  const Region& region_;
  int level_;
  const ProjectedPlaces* projected_;
  TileRule rule_;
  double sliver_deg_;
  TilePlaces places_;
  std::vector<Opened> way_;
  std::vector<TileBlock> ready_;
  View seen_;  ///< view of the node just looked at
};

}  // namespace terrella
