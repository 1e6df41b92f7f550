#pragma once

#include <array>
#include <functional>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "surface/patch_mesh.h"
#include "surface/selected_patch.h"
#include "surface/view_planes.h"

namespace terrella::bench {

/// A vertex as sent to the GPU, in double: ECEF position in metres and interpolated values.
struct DrawnVertex {
  glm::dvec3 position_m;
  glm::dvec3 direction;    ///< direction of the geodetic normal, not normalised
  glm::dvec2 lon_lat_deg;  ///< longitude unwrapped around the patch's centre
};
using DrawnTriangle = std::array<DrawnVertex, 3>;

/// Calls `visit` with every triangle of a patch, counter-clockwise from outside. `indices` must match the tree's
/// segments. Only for grids whose rows count geodetic latitude.
void for_each_triangle(const PatchTree& tree, const SelectedPatch& patch, const PatchIndices& indices,
                       const std::function<void(const DrawnTriangle&)>& visit);

/// True if the triangle's front faces the eye.
[[nodiscard]] bool faces(const DrawnTriangle& triangle, const glm::dvec3& eye_m);
/// True if all three corners lie beyond one side of the view.
[[nodiscard]] bool out_of_view(const DrawnTriangle& triangle, const View& view, const ViewPlanes& planes);

}  // namespace terrella::bench
