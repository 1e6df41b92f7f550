#pragma once

#include <glm/geometric.hpp>
#include <optional>

#include "geo/camera.h"
#include "surface/patch_tree.h"
#include "view/render_modes.h"

namespace terrella {

/// The horizon of a view: decides which patches the planet hides. It works in scaled space, where the ellipsoid is the
/// unit sphere. A surface point q is in sight iff q · eye ≥ 1, that is if its direction differs from the eye's by at
/// most the horizon's angle. A cone of directions is hidden if its axis lies further off by its half angle. thread: any
class Horizon {
 public:
  /// `inner_sphere_m`: radius of the sphere that hides the far side from an eye under the ground; 0: nothing hides it.
  Horizon(const Ellipsoid& ellipsoid, const View& view, HorizonCulling culling, double inner_sphere_m);

  /// True if all of the patch is hidden.
  [[nodiscard]] bool hides(const PatchNode& node) const {
    if (!exists_) return false;
    const double c = glm::dot(node.cone_axis, eye_direction_);
    // A cone and a horizon that reach around the planet together hide nothing.
    if (node.sin_cone * cos_ + node.cos_cone * sin_ < 0.0) return false;
    return c < node.cos_cone * cos_ - node.sin_cone * sin_;
  }
  /// True if part of the patch may be hidden.
  [[nodiscard]] bool may_cut(const PatchNode& node) const;

 private:
  bool exists_ = false;
  glm::dvec3 eye_direction_{0.0};  ///< in scaled space
  double cos_ = 1.0, sin_ = 0.0;   ///< cosine and sine of the horizon's angle
};

}  // namespace terrella
