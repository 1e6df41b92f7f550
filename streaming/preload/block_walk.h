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

/// Tiles of one level: each of these columns in each of these rows.
struct TileBlock {
  TileSpan columns;
  TileSpan rows;
  [[nodiscard]] std::int64_t count() const { return (columns.last - columns.first + 1) * (rows.last - rows.first + 1); }
};

/// Lists the tiles of a level that overlap a region, as blocks. Walks down a quadtree whose root covers the whole
/// level, and stores only the current path. Grid, ellipsoid and region must outlive the walk. thread: one at a time
class BlockWalk {
 public:
  BlockWalk(const TileGrid& grid, const Ellipsoid& ellipsoid, const Region& region, int level);
  [[nodiscard]] std::optional<TileBlock> next();

 private:
  struct Node {
    int shift;  ///< 2^shift tiles a side
    std::int64_t x, y;
  };
  struct Opened {
    Node node;
    int child = 0;  ///< index of the next child to visit
    Region::Sight sight;
  };
  /// Opens a node so that its children are visited next, or puts its blocks, if any, into `ready_`.
  void visit(const Node& node, const Region::Sight& outer);
  void add_blocks(const Node& node);
  [[nodiscard]] bool holds_places(const Node& node) const;
  [[nodiscard]] MapRect rect(const Node& node) const;

  const TileGrid& grid_;
  const Ellipsoid& ellipsoid_;
  const Region& region_;
  int level_;
  double sliver_deg_;
  TilePlaces places_;
  std::vector<Opened> way_;
  std::vector<TileBlock> ready_;
  Region::Sight seen_;
};

}  // namespace terrella
