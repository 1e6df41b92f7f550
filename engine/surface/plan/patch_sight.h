#pragma once

#include <glm/vec3.hpp>

#include "geo/camera.h"
#include "surface/patch_tree.h"

namespace terrella {

/// Distances of a patch from a view's eyes.
struct PatchSight {
  glm::dvec3 to_eye{0.0};    ///< from the centre of the patch's sphere, metres
  double distance_m = 0.0;   ///< length of to_eye
  double up = 0.0;           ///< cosine of the angle between to_eye and the surface normal
  double radius_m = 0.0;     ///< largest distance of the patch's points from the normal through its centre
  double to_axis_m = 0.0;    ///< distance of the nearer eye from that normal, within the patch's heights
  double nearest_m = 0.0;    ///< least distance of the patch's points from that eye
  double near_side_m = 0.0;  ///< distance of the patch's side towards the eye, between to_axis_m and nearest_m
  double up_facing = 0.0;    ///< as up, of either sign, on the side whose normals face the eye most
};

/// Measures patches as the eyes of a view see them. thread: any
class SightMeter {
 public:
  /// Without relief no surface point is nearer than the eye's height.
  SightMeter(const View& view, const Ellipsoid& ellipsoid, bool has_relief);

  [[nodiscard]] PatchSight measure(const PatchNode& node) const;
  [[nodiscard]] double radians_per_pixel() const { return radians_per_pixel_; }
  /// Pixels per radian in the corner of the picture, where a perspective picture magnifies most.
  [[nodiscard]] double corner_px_per_rad() const { return corner_px_per_rad_; }

 private:
  const View& view_;
  double polar_radius_m_;
  double least_distance_m_ = 0.0;
  double radians_per_pixel_;
  double corner_px_per_rad_;
};

}  // namespace terrella
