#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "geo/ellipsoid.h"
#include "streaming/preload/region.h"
#include "streaming/sets/tile_range.h"
#include "tiles/tile_grid.h"

namespace terrella {

/// Tiles of one level: all of these columns in all of these rows.
struct TileBlock {
  TileSpan columns;
  TileSpan rows;
  [[nodiscard]] std::int64_t count() const { return (columns.last - columns.first + 1) * (rows.last - rows.first + 1); }
};

/// The tiles of a level that overlap a region, as blocks: goes down a quadtree laid over the level, whose root holds
/// all of it. What it keeps is one way down. Grid, ellipsoid and region must outlive it. thread: one at a time
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
    int child = 0;  ///< to be looked at next
    Region::Segments segments;
  };
  /// What a node means: its children are to be looked at, or `ready_` has its blocks, if any.
  void visit(const Node& node, const Region::Segments& candidates);
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
  Region::Segments touched_;
};

}  // namespace terrella
