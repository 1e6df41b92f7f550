#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "geo/ellipsoid.h"
#include "streaming/preload/block_walk.h"
#include "streaming/preload/region.h"
#include "tiles/tile_grid.h"

namespace terrella {

class ProjectedPlaces;

/// Tiles of one column x: the rows [first_y, last_y] of a level. A GeoPackage is indexed by column, then row, and a
/// directory has a folder for each column. In this order lookups and requests cost least.
struct TileRun {
  int level = 0;
  std::int64_t x = 0;
  std::int64_t first_y = 0;
  std::int64_t last_y = -1;
  [[nodiscard]] std::int64_t count() const { return last_y - first_y + 1; }
  bool operator==(const TileRun&) const = default;
};

/// Yields runs one after the other, coarse levels first, each tile once. thread: one at a time
class TileFeed {
 public:
  virtual ~TileFeed() = default;
  [[nodiscard]] virtual std::optional<TileRun> next() = 0;
};

struct LevelCount {
  int level = 0;
  std::int64_t tiles = 0;
};

/// A set of wanted tiles, without a list of them. thread: any, several at once
class TilePlan {
 public:
  virtual ~TilePlan() = default;
  /// Ascending levels; some may have no tiles.
  [[nodiscard]] virtual const std::vector<LevelCount>& counts() const = 0;
  /// Starts at the first tile; the order is always the same. The plan must outlive the feed.
  [[nodiscard]] virtual std::unique_ptr<TileFeed> walk() const = 0;
  [[nodiscard]] std::int64_t total() const;
};

/// All tiles of the levels [first_level, last_level] within the grid's own that overlap a region, or lie inside it; an
/// empty region is the whole planet. Only the region is kept: counting and walking go down the quadtree, and take
/// subtrees inside the region, or pass over those outside, as a whole. `projected`: the places of a `projected` grid,
/// whose plan may have a tile beside the region; null for other grids. thread: any
[[nodiscard]] std::unique_ptr<TilePlan> plan_region(const TileGrid& grid, const Ellipsoid& ellipsoid, Region region,
                                                    int first_level, int last_level,
                                                    std::shared_ptr<const ProjectedPlaces> projected = nullptr,
                                                    TileRule rule = TileRule::overlapping);

/// The tiles of a list, each once. thread: any
[[nodiscard]] std::unique_ptr<TilePlan> plan_list(std::vector<TileId> tiles);

/// Part `index` of `count`, index in [1, count]: its share of the walk on every level, in one piece. Parts are
/// disjoint, together the whole, and differ by at most a tile a level. thread: any
struct Shard {
  std::int64_t index = 1;
  std::int64_t count = 1;
};
[[nodiscard]] std::unique_ptr<TilePlan> shard_of(std::shared_ptr<const TilePlan> whole, const Shard& shard);

}  // namespace terrella
