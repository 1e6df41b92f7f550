#include "apps/verify_tiles.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <thread>
#include <utility>

#include "streaming/tile_loader.h"
#include "streaming/tile_range.h"

namespace terrella {
namespace {

constexpr std::size_t kBatch = 1024;

void add(const LoadedTile& tile, VerifyReport& report) {
  if (tile.pixels) {
    ++report.good;
    return;
  }
  switch (tile.pixels.error().kind) {
    case Absence::absent:
      ++report.absent;
      return;
    case Absence::blank:
      ++report.blank;
      return;
    case Absence::broken:
    case Absence::failed:
    case Absence::remote:
      break;
  }
  ++report.bad;
  if (report.first_bad.size() < kMaxBadTilesListed) report.first_bad.push_back({tile.id, tile.pixels.error().why});
}

/// Loads a batch and waits for all of it.
void load(TileLoader& loader, const std::vector<TileRequest>& batch, VerifyReport& report) {
  loader.request(batch);
  for (std::size_t come = 0; come < batch.size();) {
    loader.wait(std::chrono::steady_clock::now() + std::chrono::hours(1));
    for (const LoadedTile& tile : loader.poll(std::numeric_limits<std::size_t>::max())) {
      add(tile, report);
      ++come;
    }
  }
}

std::int64_t count_all(const TileGrid& grid) {
  std::int64_t total = 0;
  for (int level = grid.min_level; level <= grid.max_level; ++level) total += count_places(grid, level);
  return total;
}

}  // namespace

VerifyReport verify_tiles(const std::shared_ptr<TileSource>& source,
                          const std::function<void(std::int64_t done, std::int64_t total)>& progress) {
  const TileGrid& grid = source->info().grid;
  const std::int64_t total = count_all(grid);
  std::int64_t done = 0;
  VerifyReport report;
  LoaderOptions options{.workers = std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, 16)};
  options.gutter = 0;
  options.mips = 1;
  TileLoader loader(source, options);
  std::vector<TileRequest> batch;
  const auto flush = [&] {
    load(loader, batch, report);
    done += static_cast<std::int64_t>(batch.size());
    batch.clear();
    progress(done, total);
  };
  for (int level = grid.min_level; level <= grid.max_level; ++level) {
    for_each_place(grid, level, [&](const TileId& id) {
      batch.push_back({id, 0.0});
      if (batch.size() == kBatch) flush();
      return true;
    });
  }
  flush();
  const auto before = [](const BadTile& a, const BadTile& b) { return a.id < b.id; };
  std::sort(report.first_bad.begin(), report.first_bad.end(), before);
  return report;
}

}  // namespace terrella
