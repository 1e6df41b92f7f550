#pragma once

#include <array>
#include <glm/vec3.hpp>

#include "geo/camera.h"
#include "surface/patch_tree.h"

// thread: any, for all of this header
namespace terrella {

/// The four side planes of the view, for spheres: dot(normal, p - eye) ≥ -radius is (partly) inside.
struct ViewPlanes {
  std::array<glm::dvec3, 4> normals;
};
[[nodiscard]] ViewPlanes view_planes(const View& view);
/// -1 outside, 0 cut, 1 inside.
[[nodiscard]] int classify(const ViewPlanes& planes, const View& view, const BoundingSphere& sphere);

}  // namespace terrella
