#include "surface/plan/horizon.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geo/scaled_space.h"

namespace terrella {
namespace {

// Angle from the eye's direction within which the surface can be seen; none if nothing hides any of it. All lengths are
// in scaled space. `length` is the eye's distance from the centre. The eyes lie in a ball of radius `spread`: the
// highest one sees furthest, and the ball itself has a width as seen from the centre.
std::optional<double> horizon_rad(double length, double spread, double inner, HorizonCulling culling) {
  const double drift = std::asin(std::min(1.0, spread / length));
  if (length - spread > 1.0) return std::acos(1.0 / (length + spread)) + drift;
  if (length - spread <= inner || length <= 0.0) return std::nullopt;
  const double half = 0.5 * std::numbers::pi + drift;
  // A line of sight that grazes the inner sphere: the angle to where it touches, and the angle from there to where it
  // leaves the surface.
  const double behind_inner = std::acos(inner / std::min(1.0, length + spread)) + std::acos(inner) + drift;
  if (culling == HorizonCulling::on) return inner > 0.0 ? std::min(half, behind_inner) : half;
  if (inner > 0.0 && behind_inner < std::numbers::pi) return behind_inner;
  return std::nullopt;
}

}  // namespace

Horizon::Horizon(const Ellipsoid& ellipsoid, const View& view, HorizonCulling culling, double inner_sphere_m) {
  const glm::dvec3 eye = view.eye.xyz_m / semi_axes_m(ellipsoid);
  const double length = glm::length(eye), spread = view.eye_spread_m / ellipsoid.b_m();
  const std::optional<double> angle = horizon_rad(length, spread, inner_sphere_m / ellipsoid.a_m(), culling);
  exists_ = angle && culling != HorizonCulling::off;
  if (!exists_) return;
  eye_direction_ = eye / length;
  cos_ = std::cos(*angle);
  sin_ = std::sin(*angle);
}

bool Horizon::may_cut(const PatchNode& node) const {
  if (!exists_) return false;
  const double c = glm::dot(node.cone_axis, eye_direction_);
  const double s = std::sqrt(std::max(0.0, 1.0 - c * c));
  return c * node.cos_cone - s * node.sin_cone < cos_;
}

}  // namespace terrella
