#include "surface/plan/patch_sight.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace terrella {
namespace {
// Part of a patch's radius that it reaches towards the eye, and of its cone that normals lean there: corners reach
// further, sides less.
constexpr double kReach = 0.7;
}  // namespace

SightMeter::SightMeter(const View& view, const Ellipsoid& ellipsoid, bool has_relief)
    : view_(view), polar_radius_m_(ellipsoid.b_m()), radians_per_pixel_(1.0 / view.pixels_per_radian()) {
  // 1 % off for the mesh, which sags.
  if (!has_relief) least_distance_m_ = 0.99 * std::abs(ellipsoid.to_geodetic(view.eye).height_m);
  const double corner = view.tan_half_fov_y * std::hypot(1.0, view.aspect());
  corner_px_per_rad_ = view.pixels_per_radian() * std::hypot(1.0, corner);
}

// Heights stand on a patch as a column along its normal. A sphere around a high column would also hold the eye that
// stands beside it, and every patch around would seem as near as can be.
PatchSight SightMeter::measure(const PatchNode& node) const {
  const double half_m = node.relief.half_m;
  const auto to_axis_m = [&](const glm::dvec3& eye) {
    const glm::dvec3 from_center = eye - node.sphere.center_m;
    const double along = std::clamp(glm::dot(from_center, node.normal), -half_m, half_m);
    return glm::length(from_center - along * node.normal);
  };
  PatchSight sight{.to_eye = view_.eye.xyz_m - node.sphere.center_m};
  sight.distance_m = std::max(glm::length(sight.to_eye), 1e-9);
  sight.up = glm::dot(sight.to_eye, node.normal) / sight.distance_m;
  const double lean_rad = kReach * std::asin(std::min(1.0, node.sin_cone));
  sight.up_facing = std::cos(std::max(0.0, std::acos(std::min(1.0, std::abs(sight.up))) - lean_rad));
  const glm::dvec3 beside = view_.eye_spread_m * view_.right;
  // Normals spread, and the column's ends with them.
  const double spread_m = half_m * 2.0 * node.relief.flat.radius_m / polar_radius_m_;
  sight.radius_m = node.sphere.radius_m - half_m + spread_m;
  sight.to_axis_m = to_axis_m(view_.eye.xyz_m - beside);
  if (view_.eye_spread_m != 0.0) sight.to_axis_m = std::min(sight.to_axis_m, to_axis_m(view_.eye.xyz_m + beside));
  sight.nearest_m = std::max({sight.to_axis_m - sight.radius_m, 1e-3 * sight.radius_m, least_distance_m_});
  sight.near_side_m = std::max(sight.to_axis_m - kReach * sight.radius_m, sight.nearest_m);
  return sight;
}

}  // namespace terrella
