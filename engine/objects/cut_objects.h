#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <vector>

#include "objects/object_shapes.h"

namespace terrella {

/// Limits of one scene. Over the first, lines are cut more coarsely; over the second, areas are left out.
inline constexpr std::size_t kMostLineVertices = 4'000'000;
inline constexpr std::size_t kMostFillTriangles = 8'000'000;

/// The lines and areas of a scene, cut so that they follow the ellipsoid. This is the slow part of making batches.
/// Colours do not matter, except that objects with alpha 0 are left empty.
struct CutObjects {
  using Way = std::vector<glm::dvec3>;  ///< ECEF, metres

  Angle step{};                            ///< step at which lines and outlines were cut
  std::vector<Way> lines;                  ///< one per line
  std::vector<FillMesh> fills;             ///< one per area
  std::vector<double> heights_m;           ///< one per area: mean height of its places
  std::vector<std::vector<Way>> outlines;  ///< per area, one per ring
};

/// Returns the length of all lines and outlines together, as an angle on the sphere.
[[nodiscard]] Angle line_length(const ObjectScene& scene);

/// Returns the step for lines and outlines of a total length: kLineStep, doubled until they fit within
/// kMostLineVertices. The step only doubles so that it, and every cut, rarely changes as a scene grows.
[[nodiscard]] Angle line_step(Angle length);

/// Cuts all lines and areas of a scene. thread: any
[[nodiscard]] CutObjects cut_objects(const ObjectScene& scene, const Ellipsoid& ellipsoid, Angle step);

}  // namespace terrella
