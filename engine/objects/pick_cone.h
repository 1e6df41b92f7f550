#pragma once

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "geo/camera.h"

namespace terrella {

/// All places within a number of pixels of a pixel, in front of the eye. A pure value. thread: any
class PickCone {
 public:
  PickCone(const View& view, glm::dvec2 pixel_px, double reach_px)
      : eye_m_(view.eye.xyz_m), ray_(pixel_ray(view, pixel_px).xyz) {
    // A pixel spans the largest angle at the middle of the picture.
    const double angle = reach_px / view.pixels_per_radian();
    constexpr double kWide = 1.0;
    tangent_ = angle < kWide ? std::tan(1.001 * angle) : -1.0;
  }
  /// False only if no place of the ball lies in the cone, or if a value is not finite.
  [[nodiscard]] bool meets(const glm::dvec3& center_m, double radius_m) const {
    const glm::dvec3 to = center_m - eye_m_;
    const double along = glm::dot(to, ray_);
    if (!(along >= -radius_m)) return false;
    if (tangent_ < 0.0) return true;
    const double reach_m = radius_m + (along + radius_m) * tangent_;
    return glm::dot(to, to) - along * along <= reach_m * reach_m * (1.0 + 1e-9) + 1e-6;
  }

 private:
  glm::dvec3 eye_m_, ray_;
  double tangent_;  ///< negative: the cone is about as wide as a half space
};

/// A ball around an object or a part of one, ECEF.
struct Ball {
  glm::dvec3 center_m{0.0};
  double radius_m = 0.0;
};

}  // namespace terrella
