#include "surface/view_planes.h"

#include <glm/geometric.hpp>

namespace terrella {

ViewPlanes view_planes(const View& view) {
  const double ty = view.tan_half_fov_y;
  const double tx = ty * view.aspect();
  const glm::dvec3 left = view.forward * (tx - view.shear_x), right = view.forward * (tx + view.shear_x);
  return {{glm::normalize(left + view.right), glm::normalize(right - view.right),
           glm::normalize(view.forward * ty + view.up), glm::normalize(view.forward * ty - view.up)}};
}

int classify(const ViewPlanes& planes, const View& view, const BoundingSphere& sphere) {
  const glm::dvec3 p = sphere.center_m - view.eye.xyz_m;
  int result = 1;
  for (const glm::dvec3& normal : planes.normals) {
    const double d = glm::dot(normal, p);
    if (d < -sphere.radius_m - view.eye_spread_m) return -1;
    if (d < sphere.radius_m + view.eye_spread_m) result = 0;
  }
  return result;
}

}  // namespace terrella
