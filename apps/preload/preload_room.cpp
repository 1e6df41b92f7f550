#include "apps/preload/preload_room.h"

#include <fmt/format.h>

#include <cmath>
#include <ctime>

#include "apps/open_scene/open_cache.h"
#include "apps/preload/preload_progress.h"
#include "streaming/cache/cache_limit.h"
#include "streaming/cache/cache_report.h"
#include "streaming/cache/cache_schema.h"

namespace terrella {
namespace {

/// Size of an incompressible picture, in bytes per pixel.
constexpr double kMostBytesAPixel = 4.0;
/// A sample of twenty has an error of ten to twenty per cent.
constexpr double kAdvisedSpare = 1.25;

double room_bytes(const PreloadCommand& command) {
  const CacheBudget budget = cache_budget(megabytes(command.cache_size_mb), kCachePageBytes);
  return static_cast<double>(budget.file_pages * kCachePageBytes);
}

/// Names the coarse levels that fit, if any: "; levels 0-5 need about 6 MB".
std::string levels_that_fit(const PreloadCommand& command, const TilePlan& plan, const RoomNeed& need, double a_tile) {
  std::string fit;
  std::int64_t tiles = 0;
  const std::vector<LevelCount>& levels = plan.counts();
  for (const LevelCount& level : levels) {
    tiles += level.tiles;
    const double bytes = need.pinned_bytes + file_bytes(tiles, a_tile);
    if (bytes > room_bytes(command)) break;
    fit = fmt::format("; levels {}-{} need about {}", levels.front().level, level.level, bytes_text(bytes));
  }
  return fit;
}

}  // namespace

RoomNeed room_need(const PreloadCommand& command, const TilePlan& plan, std::int64_t settled) {
  RoomNeed need{.tiles = plan.total() - settled};
  // If the file cannot be counted, nothing is known; a tile without room is reported later.
  const Result<CacheReport> report = read_cache_report(command.output, std::time(nullptr));
  if (report && report->tiles > 0) {
    const double share = static_cast<double>(report->pinned_tiles) / static_cast<double>(report->tiles);
    need.pinned_bytes = share * static_cast<double>(report->used_bytes);
  }
  return need;
}

bool surely_fits(const PreloadCommand& command, const RoomNeed& need, int tile_px) {
  if (command.cache_size_mb == 0 || need.tiles == 0) return true;
  const double a_tile = kMostBytesAPixel * tile_px * tile_px;
  return need.pinned_bytes + file_bytes(need.tiles, a_tile) <= room_bytes(command);
}

std::optional<Error> find_no_room(const PreloadCommand& command, const TilePlan& plan, const RoomNeed& need,
                                  const SizeSample& sample) {
  if (command.cache_size_mb == 0 || need.tiles == 0 || sample.answered == 0) return std::nullopt;
  const double bytes = need.pinned_bytes + file_bytes(need.tiles, sample.bytes_per_tile);
  if (bytes <= room_bytes(command)) return std::nullopt;
  return Error{fmt::format(
      "{}: the plan needs about {}, by a sample of {} tiles, and --cache-size {} allows {}; give --cache-size {} or "
      "more, or fewer levels or a smaller area{}",
      command.output, bytes_text(bytes), sample.answered, command.cache_size_mb,
      bytes_text(static_cast<double>(megabytes(command.cache_size_mb))),
      std::ceil(bytes * kAdvisedSpare / static_cast<double>(megabytes(1))),
      levels_that_fit(command, plan, need, sample.bytes_per_tile))};
}

}  // namespace terrella
