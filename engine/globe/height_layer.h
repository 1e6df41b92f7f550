#pragma once

#include <deque>
#include <memory>
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

  /// Adds arrived tiles to the relief, one by one, until `meshes` meshes of the given patches are out of date. Appends
  /// failed tiles to `missing`. True if a tile has arrived.
  bool take_finished(const PatchTree& tree, const std::vector<SelectedPatch>& patches, int meshes,
                     std::deque<MissingTile>& missing);
  /// Requests the tiles that the patches want and that are not loaded. Returns their number.
  int ask(const std::vector<SelectedPatch>& patches);
  /// See TileStream::has_news().
  [[nodiscard]] bool has_news() const { return stream_.has_news(); }

 private:
  std::shared_ptr<Relief> relief_;  ///< shared with each Ground
  TileStream<HeightTile> stream_;
  std::string attribution_;
};

}  // namespace terrella
