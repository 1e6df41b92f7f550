#include "globe/height_layer.h"

#include <algorithm>
#include <utility>

namespace terrella {

HeightLayer::HeightLayer(const ElevationSource& elevation, const GlobeOptions& options,
                         std::shared_ptr<ArrivalBell> bell)
    : relief_(std::make_shared<Relief>(options.body.ellipsoid, elevation.grid(), options.exaggeration,
                                       options.height_bytes)),
      stream_(HeightLoader(elevation, {.workers = std::max(1, decoder_threads() / 2), .bell = std::move(bell)}),
              relief_->tiles(), LayerId::none, options.retry_after),
      attribution_(elevation.tiles()->info().attribution) {}

void HeightLayer::take_finished(std::span<Viewer> viewers, int meshes, std::deque<MissingTile>& missing) {
  for (int stale = 0; stale < meshes;) {
    std::optional<LoadedHeights> loaded = stream_.take(missing);
    if (!loaded) break;
    for (Viewer& viewer : viewers) {
      const int touched = relief_->touched(viewer.tree, loaded->id, viewer.patches);
      // A tile that only another view wanted changes nothing here, unless it lies under the patches.
      viewer.arrived = viewer.arrived || touched > 0 || viewers.size() == 1;
      if (&viewer == viewers.data()) stale += touched;
    }
    relief_->add(std::move(*loaded->tile));
  }
}

int HeightLayer::ask(std::span<const Viewer> viewers) {
  stream_.retry();
  std::vector<WantedTile> wanted = relief_->want(viewers.front().patches);
  const std::size_t of_first = wanted.size();
  for (const Viewer& other : viewers.subspan(1)) relief_->want_too(other.patches, wanted);
  std::vector<TileRequest> requests;
  for (const WantedTile& tile : wanted) requests.push_back({tile.id, tile.priority});
  stream_.request(requests);
  return static_cast<int>(of_first);
}

}  // namespace terrella
