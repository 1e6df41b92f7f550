#include "apps/commands/verify_tiles.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <thread>
#include <utility>

#include "streaming/tile_lister.h"
#include "tiles/tile_loader.h"
#include "tiles/tile_range.h"

namespace terrella {
namespace {

constexpr std::size_t kBatch = 1024;

void add(const LoadedTile& tile, VerifyReport& report) {
  if (tile.tile) {
    ++report.good;
    return;
  }
  switch (tile.tile.error().kind) {
    case MissingKind::absent:
      ++report.absent;
      return;
    case MissingKind::blank:
      ++report.blank;
      return;
    case MissingKind::broken:
    case MissingKind::failed:
    case MissingKind::remote:
      break;
  }
  ++report.bad;
  if (report.first_bad.size() < kMaxBadTilesListed) report.first_bad.push_back({tile.id, tile.tile.error().why});
}

/// Loads a batch and waits for all its tiles.
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

/// Visits a level's rows of squeezed tiles, with the number of tiles in each.
void for_each_squeezed_row(const TileGrid& grid, int level,
                           const std::function<void(std::int64_t y, int squeeze, std::int64_t tiles)>& call) {
  if (!grid.reduced) return;
  for (std::int64_t y = 0; y < rows(grid, level); ++y) {
    const int squeeze = squeeze_of_row(grid, level, y);
    if (squeeze > 0) call(y, squeeze, squeezed_columns(grid, level, squeeze));
  }
}

std::int64_t count_all(const TileGrid& grid) {
  std::int64_t total = 0;
  for (int level = grid.min_level; level <= grid.max_level; ++level) {
    total += count_places(grid, level);
    for_each_squeezed_row(grid, level, [&](std::int64_t, int, std::int64_t tiles) { total += tiles; });
  }
  return total;
}

std::int64_t count_listed(TileSource& source) {
  const TileGrid& grid = source.info().grid;
  std::int64_t total = 0;
  for (int level = grid.min_level; level <= grid.max_level; ++level) total += source.count_tiles(level).value_or(0);
  return total;
}

/// Collects tiles and loads them in batches.
class Verifier {
 public:
  Verifier(const std::shared_ptr<TileSource>& source, std::int64_t total, const VerifyProgress& progress)
      : loader_(source, options()), total_(total), progress_(progress) {}

  /// Returns false once the progress has requested a stop.
  bool take(const TileId& id) {
    batch_.push_back({id, 0.0});
    if (batch_.size() == kBatch) flush();
    return !stopped_;
  }

  Result<VerifyReport> finish() {
    if (!stopped_) flush();
    if (stopped_) return Error{fmt::format("stopped after {} tiles; {} of them are broken", done_, report_.bad)};
    const auto before = [](const BadTile& a, const BadTile& b) { return a.id < b.id; };
    std::sort(report_.first_bad.begin(), report_.first_bad.end(), before);
    return std::move(report_);
  }

 private:
  static LoaderOptions options() {
    LoaderOptions options{.workers = std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, 16)};
    options.gutter = 0;
    options.mips = 1;
    return options;
  }

  // A damaged set may list a tile twice, and the loader delivers the tile once.
  void flush() {
    std::ranges::sort(batch_, {}, &TileRequest::id);
    const auto same = [](const TileRequest& a, const TileRequest& b) { return a.id == b.id; };
    batch_.erase(std::unique(batch_.begin(), batch_.end(), same), batch_.end());
    load(loader_, batch_, report_);
    done_ += static_cast<std::int64_t>(batch_.size());
    batch_.clear();
    stopped_ = !progress_(done_, std::max(done_, total_));
  }

  TileLoader loader_;
  const std::int64_t total_;
  const VerifyProgress& progress_;
  std::int64_t done_ = 0;
  bool stopped_ = false;
  std::vector<TileRequest> batch_;
  VerifyReport report_;
};

Result<VerifyReport> verify_listed(const std::shared_ptr<TileSource>& source, TileLister& lister,
                                   const VerifyProgress& progress) {
  Verifier verifier(source, count_listed(*source), progress);
  const Status listed = lister.for_each_tile([&](const TileId& id) { return verifier.take(id); });
  if (!listed) return listed.error();
  Result<VerifyReport> report = verifier.finish();
  if (!report) return report;
  const std::int64_t found = report->good + report->blank + report->bad;
  report->absent = std::max<std::int64_t>(0, count_all(source->info().grid) - found);
  return report;
}

Result<VerifyReport> verify_places(const std::shared_ptr<TileSource>& source, const VerifyProgress& progress) {
  const TileGrid& grid = source->info().grid;
  Verifier verifier(source, count_all(grid), progress);
  const auto take = [&](const TileId& id) { return verifier.take(id); };
  for (int level = grid.min_level; level <= grid.max_level; ++level) {
    for_each_place(grid, level, take);
    for_each_squeezed_row(grid, level, [&](std::int64_t y, int squeeze, std::int64_t tiles) {
      for (std::int64_t x = 0; x < tiles && take({level, x, y, squeeze});) ++x;
    });
  }
  return verifier.finish();
}

}  // namespace

Result<VerifyReport> verify_tiles(const std::shared_ptr<TileSource>& source, const VerifyProgress& progress) {
  if (auto* lister = dynamic_cast<TileLister*>(source.get())) return verify_listed(source, *lister, progress);
  return verify_places(source, progress);
}

}  // namespace terrella
