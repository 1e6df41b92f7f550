#pragma once

#include "surface/selected_patch.h"
#include "surface/tree_growth.h"
#include "surface/view_planes.h"

namespace terrella {

/// Decides which cells of a window are in view: within the four side planes and the horizon. thread: any
class CellView {
 public:
  /// Heights stand over the horizon, so with relief the horizon limits nothing.
  CellView(const View& view, const Ellipsoid& ellipsoid, bool has_relief);

  /// False if nothing of the cell is in view. The growth makes the cell's lattice if it is needed.
  [[nodiscard]] bool sees(const SelectedPatch& patch, const TileWindow& window, int x, int y, TreeGrowth& growth) const;

 private:
  /// Limits that a sphere lies beyond, a bit for each: side planes 0 to 3, horizon 4.
  struct Beyond {
    unsigned some = 0;    ///< some of the sphere
    unsigned middle = 0;  ///< its centre
    unsigned all = 0;     ///< all of the sphere
  };
  [[nodiscard]] Beyond beyond(const BoundingSphere& sphere) const;
  [[nodiscard]] unsigned all_beyond(const glm::dvec3& p_m, double reach_m, unsigned limits) const;
  [[nodiscard]] bool sees_part(const SurfaceLattice& lattice, double relief_m, unsigned limits) const;

  glm::dvec3 eye_m_;
  double eye_spread_m_;
  ViewPlanes planes_;
  bool has_horizon_;
  glm::dvec3 eye_over_axes2_{0.0};
  double horizon_;        ///< least dot product of eye_over_axes2_ with a point that some eye sees
  double horizon_per_m_;  ///< most that a metre changes the horizon's dot product
  double least_radius_per_m_;
};

}  // namespace terrella
