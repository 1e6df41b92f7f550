#include "apps/viewer/clusters/layer_clusters.h"

namespace terrella {

Status LayerClusters::follow(Globe& globe, LayerId layer, double radius_px, Viewport picture) {
  if (layer != layer_) shown_.reset();
  if (shown_ && radius_px != radius_px_) {
    Status ended = shown_->end(globe);
    shown_.reset();
    if (!ended) return ended;
  }
  layer_ = layer;
  radius_px_ = radius_px;
  if (radius_px == 0.0) return Done{};
  if (!shown_) {
    Result<PointClusters> made = PointClusters::make(layer, points_, radius_px);
    if (!made) return made.error();
    shown_ = *std::move(made);
  }
  return shown_->update(globe, picture);
}

}  // namespace terrella
