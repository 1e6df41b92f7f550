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

bool HeightLayer::take_finished(const PatchTree& tree, const std::vector<SelectedPatch>& patches, int meshes,
                                std::deque<MissingTile>& missing) {
  bool arrived = false;
  for (int stale = 0; stale < meshes;) {
    std::optional<LoadedHeights> loaded = stream_.take(missing);
    if (!loaded) break;
    stale += relief_->touched(tree, loaded->id, patches);
    relief_->add(std::move(*loaded->tile));
    arrived = true;
  }
  return arrived;
}

int HeightLayer::ask(const std::vector<SelectedPatch>& patches) {
  stream_.retry();
  std::vector<TileRequest> requests;
  for (const WantedTile& tile : relief_->want(patches)) requests.push_back({tile.id, tile.priority});
  stream_.request(requests);
  return static_cast<int>(requests.size());
}

}  // namespace terrella
