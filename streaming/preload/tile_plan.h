#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "geo/ellipsoid.h"
#include "streaming/preload/region.h"
#include "tiles/tile_grid.h"

namespace terrella {

/// Tiles below one another: column x, rows [first_y, last_y] of a level. GeoPackages are indexed by column, then row,
/// and directories have a folder a column, so this is the order in which looking and asking cost least.
struct TileRun {
  int level = 0;
  std::int64_t x = 0;
  std::int64_t first_y = 0;
  std::int64_t last_y = -1;
  [[nodiscard]] std::int64_t count() const { return last_y - first_y + 1; }
  bool operator==(const TileRun&) const = default;
};

/// Runs one after the other, coarse levels first, each tile once. thread: one at a time
class TileFeed {
 public:
  virtual ~TileFeed() = default;
  [[nodiscard]] virtual std::optional<TileRun> next() = 0;
};

struct LevelCount {
  int level = 0;
  std::int64_t tiles = 0;
};

/// Which tiles are wanted, without a list of them. thread: any, several at once
class TilePlan {
 public:
  virtual ~TilePlan() = default;
  [[nodiscard]] virtual const std::vector<LevelCount>& counts() const = 0;  ///< ascending levels; some may have none
  /// From the first tile, the same order every time. The plan must outlive the feed.
  [[nodiscard]] virtual std::unique_ptr<TileFeed> walk() const = 0;
  [[nodiscard]] std::int64_t total() const;
};

/// All tiles of the levels [first_level, last_level] within the grid's own that overlap a region; an empty region is
/// the whole planet. Nothing is kept but the region: counting and walking go down the quadtree, pass over what lies
/// outside as a whole and take what lies inside as a whole. thread: any
[[nodiscard]] std::unique_ptr<TilePlan> plan_region(const TileGrid& grid, const Ellipsoid& ellipsoid, Region region,
                                                    int first_level, int last_level);

/// The tiles of a list, each once. thread: any
[[nodiscard]] std::unique_ptr<TilePlan> plan_list(std::vector<TileId> tiles);

/// thread: any. Part `index` of `count`, index in [1, count]: of every level its share of the walk, in one piece. Parts
/// are disjoint, together the whole, and differ by at most a tile a level.
struct Shard {
  std::int64_t index = 1;
  std::int64_t count = 1;
};
[[nodiscard]] std::unique_ptr<TilePlan> shard_of(std::shared_ptr<const TilePlan> whole, const Shard& shard);

}  // namespace terrella
