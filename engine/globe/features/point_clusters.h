#pragma once

#include <memory>
#include <span>
#include <vector>

#include "base/result.h"
#include "geo/objects.h"
#include "globe/globe.h"

namespace terrella {

/// A feature that may be in a cluster.
struct ClusterPoint {
  ObjectId id = ObjectId::none;  ///< under 2^62
  Geodetic place = {};
};

/// Returns the features with one marker or icon and no other part than a label, in ascending order of ids. thread: any
[[nodiscard]] std::vector<ClusterPoint> cluster_points(const ObjectScene& scene);

/// Clusters of the markers and icons of an object layer: those that lie within some pixels of one another in the
/// picture are drawn as one disc with their number. The discs are objects of the layer, so its opacity, order and
/// visibility are theirs. thread: that of the globe
class PointClusters {
 public:
  /// Range of the radius, pixels.
  static constexpr double kLeastRadius_px = 10.0, kMostRadius_px = 400.0;

  /// Takes features of a layer, which are all visible. Costs some 10 µs a point. Fails if the radius is out of range.
  /// thread: any
  [[nodiscard]] static Result<PointClusters> make(LayerId layer, std::span<const ClusterPoint> points,
                                                  double radius_px);
  PointClusters(PointClusters&&) noexcept;
  PointClusters& operator=(PointClusters&&) noexcept;
  ~PointClusters();

  /// Edits the layer for the globe's main view in a picture. Call this before each frame; it costs little if the view
  /// has not changed, else a little for each disc. Fails if the layer, or one of its points, is not there any more.
  Status update(Globe& globe, Viewport picture);
  /// Removes the discs and shows all points. Fails if the layer is not there any more.
  Status end(Globe& globe);

  /// The ids of the features in a cluster, in ascending order; empty for an object that is none.
  [[nodiscard]] std::vector<ObjectId> features_of(ObjectId cluster) const;

 private:
  struct State;
  explicit PointClusters(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace terrella
