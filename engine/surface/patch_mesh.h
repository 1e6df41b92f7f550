#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "geo/split_position.h"
#include "surface/patch_tree.h"

namespace terrella {

/// A vertex of a patch as the GPU keeps it. The position is ECEF metres split in two floats: high + low is the double
/// position to 2⁻⁴⁸ of its size. Two patches that share a vertex hold the same bits. So both draw the same point
/// relative to the eye ((high - eye_high) + (low - eye_low)) and on the screen: no cracks.
struct PatchVertex {
  glm::vec3 position_high_m;
  glm::vec3 position_low_m;
  glm::vec3 direction;   ///< row_direction() minus the centre's, over the centre's length: exact to the patch's size
  glm::vec2 offset_deg;  ///< longitude and row latitude (TileGrid) relative to the patch's centre
};
static_assert(sizeof(PatchVertex) == 44);

/// The (segments + 1)² vertices of a patch, row-major in (i, j). Longitude unwraps around the patch's centre; a vertex
/// on the antimeridian belongs to the patch's side; one on a pole takes the centre's longitude. Raised by
/// the node's heights, if it has any. thread: any
[[nodiscard]] std::vector<PatchVertex> patch_vertices(const PatchTree& tree, const PatchNode& node);

/// Triangles for all patches: 2 diagonals (paper 1, (2)) × 16 sets of coarse sides, each a range of one list.
/// On a coarse side every odd vertex gives way to the even one before it, so that the edge is the neighbour's.
struct PatchIndices {
  struct Range {
    std::uint32_t first = 0;
    std::uint32_t count = 0;
  };
  std::vector<std::uint16_t> indices;  ///< counter-clockwise seen from outside
  Range ranges[2][16];                 ///< [forward diagonal][coarse sides]
};
[[nodiscard]] PatchIndices patch_indices(int segments);

}  // namespace terrella
