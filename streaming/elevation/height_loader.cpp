#include "streaming/elevation/height_loader.h"

#include <cassert>

#include "streaming/tile_scheduler.h"

namespace terrella {

struct HeightLoader::Impl : TileScheduler<HeightTile> {
  using TileScheduler::TileScheduler;
};

HeightLoader::HeightLoader(const ElevationSource& source, const HeightLoaderOptions& options)
    : impl_(std::make_shared<Impl>(
          source.tiles(), [source](const TileId& id, const EncodedTile& tile) { return source.decode(id, tile); },
          options.max_finished_bytes)) {
  assert(options.workers >= 1 && options.workers <= 64);
  impl_->start(options.workers);
}

HeightLoader::~HeightLoader() { impl_->stop(); }

void HeightLoader::request(std::span<const TileRequest> wanted) { impl_->request(wanted); }

std::vector<LoadedHeights> HeightLoader::poll(std::size_t max_bytes) {
  std::vector<LoadedHeights> loaded;
  for (auto& finished : impl_->poll(max_bytes)) loaded.push_back({finished.id, std::move(finished.tile)});
  return loaded;
}

bool HeightLoader::wait(std::chrono::steady_clock::time_point deadline) { return impl_->wait(deadline); }

LoaderCounts HeightLoader::counts() const { return impl_->counts(); }

}  // namespace terrella
