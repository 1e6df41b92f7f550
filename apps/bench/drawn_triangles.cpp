#include "apps/bench/drawn_triangles.h"

#include <algorithm>
#include <glm/geometric.hpp>

namespace terrella::bench {
namespace {

std::vector<DrawnVertex> drawn_vertices(const PatchTree& tree, const PatchNode& node) {
  std::vector<DrawnVertex> vertices;
  const double cos_lon = node.frame.x, sin_lon = node.frame.y, cos_lat = node.frame.z, sin_lat = node.frame.w;
  const glm::dvec3 centre(cos_lat * cos_lon, cos_lat * sin_lon, sin_lat);
  for (const PatchVertex& v : patch_vertices(tree, node)) {
    vertices.push_back({glm::dvec3(v.position_high_m) + glm::dvec3(v.position_low_m), centre + glm::dvec3(v.direction),
                        glm::dvec2(node.lon_center_deg, node.row_center_deg) + glm::dvec2(v.offset_deg)});
  }
  return vertices;
}

}  // namespace

void for_each_triangle(const PatchTree& tree, const SelectedPatch& patch, const PatchIndices& indices,
                       const std::function<void(const DrawnTriangle&)>& visit) {
  const std::vector<DrawnVertex> vertices = drawn_vertices(tree, *patch.node);
  const PatchIndices::Range range = indices.ranges[forward_diagonal(patch.node->id) ? 1 : 0][patch.coarse_sides];
  for (std::uint32_t k = range.first; k < range.first + range.count; k += 3) {
    const DrawnTriangle triangle{vertices[indices.indices[k]], vertices[indices.indices[k + 1]],
                                 vertices[indices.indices[k + 2]]};
    // A coarse side collapses some triangles.
    if (triangle[0].position_m == triangle[1].position_m || triangle[1].position_m == triangle[2].position_m ||
        triangle[2].position_m == triangle[0].position_m) {
      continue;
    }
    visit(triangle);
  }
}

bool faces(const DrawnTriangle& t, const glm::dvec3& eye_m) {
  const glm::dvec3 normal = glm::cross(t[1].position_m - t[0].position_m, t[2].position_m - t[0].position_m);
  return glm::dot(normal, eye_m - t[0].position_m) > 0.0;
}

bool out_of_view(const DrawnTriangle& t, const View& view, const ViewPlanes& planes) {
  return std::ranges::any_of(planes.normals, [&](const glm::dvec3& inward) {
    return std::ranges::all_of(
        t, [&](const DrawnVertex& v) { return glm::dot(inward, v.position_m - view.eye.xyz_m) < 0.0; });
  });
}

}  // namespace terrella::bench
