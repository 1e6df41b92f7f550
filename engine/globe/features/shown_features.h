#pragma once

#include <memory>
#include <vector>

#include "base/result.h"
#include "geo/shown_when.h"
#include "globe/globe.h"

namespace terrella {

/// Returns the zoom level of the globe's main view in a picture, [kLeastZoom, kMostZoom]: that of the ground straight
/// below or above the eye, as if it were seen in the middle of the picture. It does not change with the direction of
/// view. 256 px tiles of Web Mercator's level z + 1 have as many pixels at the equator. thread: that of the globe
[[nodiscard]] double zoom_of(const Globe& globe, Viewport picture);

/// Shows features of an object layer at some zoom levels and instants only (ObjectChange::filtered). Instants are those
/// of Globe::set_time(); without a time, features of all instants are shown. thread: that of the globe
class ShownFeatures {
 public:
  /// Takes features of a layer, none of which is hidden by `filtered`. Fails if a zoom level is out of its range.
  /// thread: any
  [[nodiscard]] static Result<ShownFeatures> make(LayerId layer, std::vector<ShownWhen> features);
  ShownFeatures(ShownFeatures&&) noexcept;
  ShownFeatures& operator=(ShownFeatures&&) noexcept;
  ~ShownFeatures();

  /// Edits the layer for the globe's main view in a picture and its time. Call this before each frame; it costs
  /// little, and a little for each feature that comes or goes. Fails if the layer or one of its features is not there
  /// any more.
  Status update(Globe& globe, Viewport picture);
  /// Shows all features. Fails if the layer or one of its features is not there any more.
  Status end(Globe& globe);

 private:
  struct State;
  explicit ShownFeatures(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace terrella
