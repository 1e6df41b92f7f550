#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "globe/features/point_clusters.h"

namespace terrella {

/// Radius of clusters that the panel switches on, pixels.
inline constexpr double kClusterRadius_px = 40.0;

/// Clusters of a layer in the window, which may come and go. thread: main
class LayerClusters {
 public:
  explicit LayerClusters(std::vector<ClusterPoint> points) : points_(std::move(points)) {}

  /// Shows clusters of this radius, or none for 0, as the globe's camera sees the layer in a picture. Call it before
  /// each frame. The layer may have another id than before, as after an undone removal.
  Status follow(Globe& globe, LayerId layer, double radius_px, Viewport picture);

 private:
  std::vector<ClusterPoint> points_;
  std::optional<PointClusters> shown_;
  LayerId layer_ = LayerId::none;
  double radius_px_ = 0.0;
};

}  // namespace terrella
