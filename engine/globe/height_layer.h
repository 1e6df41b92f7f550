#pragma once

#include <deque>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "globe/globe.h"
#include "globe/tile_stream.h"
#include "surface/relief.h"
#include "tiles/arrival_bell.h"
#include "tiles/height_loader.h"

namespace terrella {

/// The elevation of a globe: its tiles from the source to the relief, which raises the patches of the image layers.
/// thread: main
class HeightLayer {
 public:
  /// `bell` rings when a tile has arrived.
  HeightLayer(const ElevationSource& elevation, const GlobeOptions& options, std::shared_ptr<ArrivalBell> bell);

  [[nodiscard]] const std::shared_ptr<Relief>& relief() const { return relief_; }  ///< never null
  [[nodiscard]] const std::string& attribution() const { return attribution_; }
  /// True if any heights are loaded.
  [[nodiscard]] bool is_on_screen() const { return relief_->field().size() > 0; }

  /// The patches of one view, and the answer: true if heights have arrived under them.
  struct Viewer {
    const PatchTree& tree;
    const std::vector<SelectedPatch>& patches;
    bool arrived = false;
  };
  /// Adds arrived tiles to the relief, one by one, until `meshes` meshes of the first viewer's patches are out of date.
  /// Appends failed tiles to `missing`. Tells each viewer.
  void take_finished(std::span<Viewer> viewers, int meshes, std::deque<MissingTile>& missing);
  /// Requests the tiles that the viewers' patches want and that are not loaded. Returns the number of those that the
  /// first one wants.
  int ask(std::span<const Viewer> viewers);
  /// True if no requested tile is on its way. Arrived tiles may wait.
  [[nodiscard]] bool has_all() const {
    const LoaderCounts counts = stream_.counts();
    return counts.waiting + counts.running + counts.fetching == 0;
  }
  /// See TileStream.
  [[nodiscard]] const StreamCounts& taken() const { return stream_.taken(); }
  [[nodiscard]] bool has_news(const StreamCounts& since, bool wants) const { return stream_.has_news(since, wants); }

 private:
  std::shared_ptr<Relief> relief_;  ///< shared with each Ground
  TileStream<HeightTile> stream_;
  std::string attribution_;
};

}  // namespace terrella
