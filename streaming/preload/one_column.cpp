#include "streaming/preload/one_column.h"

#include <algorithm>

namespace terrella {
namespace {

constexpr std::int64_t kRowsAtOnce = 4096;

/// Counts the rows of a run that are tiles and those that are recorded as missing.
struct RunCount {
  std::int64_t tiles = 0, missing = 0;
};

Result<RunCount> count(const TileRun& run, TileCache& cache) {
  RunCount found;
  const std::int64_t last = std::min(run.last_y, run.first_y + kRowsAtOnce - 1);
  const Status looked = cache.peek_column(
      run.level, run.x, run.first_y, last,
      [&](std::int64_t, const CacheRecord& record) { ++(record.missing ? found.missing : found.tiles); });
  if (!looked) return looked.error();
  return found;
}

}  // namespace

Result<bool> looks_like_one_column(const TilePlan& plan, const TileGrid& grid, TileCache& cache) {
  bool west = false, east = false, below_root = false;
  const auto feed = plan.walk();
  for (auto run = feed->next(); run; run = feed->next()) {
    const bool eastern = run->x >= columns(grid, run->level) / 2;
    for (TileRun rest = *run; rest.count() > 0; rest.first_y += kRowsAtOnce) {
      const auto found = count(rest, cache);
      if (!found) return found.error();
      if ((eastern ? found->missing : found->tiles) < std::min(rest.count(), kRowsAtOnce)) return false;
    }
    (eastern ? east : west) = true;
    below_root = below_root || run->level > 0;
  }
  return west && east && below_root;
}

}  // namespace terrella
