#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

// Paper 1: A. Zuev, "Method of synthesis of a seamless textured sphere for visualization in geoinformation and
// cartographic systems", 2023.

namespace terrella::bench {

struct PaperVertex {
  glm::vec3 unit;  ///< on the unit sphere, z to the north pole
  glm::vec2 uv;    ///< u east from -180° (up to 2 beside the antimeridian), v south from the north pole
};
struct PaperMesh {
  std::vector<PaperVertex> vertices;
  std::vector<std::uint32_t> indices;  ///< triangles, counter-clockwise from outside
};

/// The cube sphere of paper 1, read with the corrections of this project's digest. Vertices
/// follow formula (1): P = N + s(iT + jB) over -1…1, normalised. Diagonals follow the face's quadrant (2); texture
/// coordinates are equirectangular (3). A quad whose u straddles the antimeridian gets copies of its small-u corners
/// with u + 1. `n` is even and ≥ 2; n = 48 gives 27,648 triangles and 14,598 vertices.
[[nodiscard]] PaperMesh paper_mesh(int n);

}  // namespace terrella::bench
