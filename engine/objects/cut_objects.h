#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <vector>

#include "objects/object_shapes.h"

namespace terrella {

/// Lines are cut more coarsely, and areas are left out, if a scene would need more than this.
inline constexpr std::size_t kMostLineVertices = 4'000'000;
inline constexpr std::size_t kMostFillTriangles = 8'000'000;

/// The lines and areas of a scene, cut so that they follow the ellipsoid: the slow part of making batches. Colours play
/// no part in it, but for what has alpha 0, which is left empty.
struct CutObjects {
  using Way = std::vector<glm::dvec3>;  ///< ECEF, metres

  Angle step{};                            ///< that lines and outlines were cut at
  std::vector<Way> lines;                  ///< one for each line
  std::vector<FillMesh> fills;             ///< one for each area
  std::vector<double> heights_m;           ///< one for each area: the mean of its places'
  std::vector<std::vector<Way>> outlines;  ///< for each area, one for each ring
};

/// The length of all lines and outlines together, as an angle on the sphere.
[[nodiscard]] Angle line_length(const ObjectScene& scene);

/// The step that lines and outlines of that length are cut at: kLineStep, or as many doublings of it as keep them
/// within kMostLineVertices. Doublings, so that the step, and with it every cut, rarely changes as a scene grows.
[[nodiscard]] Angle line_step(Angle length);

/// Cuts all lines and areas of a scene. thread: any
[[nodiscard]] CutObjects cut_objects(const ObjectScene& scene, const Ellipsoid& ellipsoid, Angle step);

}  // namespace terrella
