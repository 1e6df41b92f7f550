#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <functional>

#include "geo/cube_sphere.h"

namespace terrella {

/// One quadtree cell of a cube face: level L splits the face into 2^L × 2^L; x runs with i, y with j.
/// Levels 0…kMaxPatchLevel. From level 1 on the antimeridian and the poles lie on patch borders and corners.
struct PatchId {
  CubeFace face = CubeFace::pos_x;
  int level = 0;
  std::uint32_t x = 0;
  std::uint32_t y = 0;
  auto operator<=>(const PatchId&) const = default;
};
inline constexpr int kMaxPatchLevel = 26;

/// Sides in the face's own (i, j) axes.
enum class PatchSide : int { west = 0, east = 1, south = 2, north = 3 };  // -i, +i, -j, +j

[[nodiscard]] PatchId parent(const PatchId& id);                   ///< id.level ≥ 1
[[nodiscard]] std::array<PatchId, 4> children(const PatchId& id);  ///< (0,0) (1,0) (0,1) (1,1) in (x, y)
/// The patch of the same level across a side, on this face or the next one.
[[nodiscard]] PatchId neighbour(const PatchId& id, PatchSide side);
/// True if `ancestor` is `id` or contains it.
[[nodiscard]] bool contains(const PatchId& ancestor, const PatchId& id);
/// The patch of `level` that holds a direction.
[[nodiscard]] PatchId patch_at(const EcefDir& normal, int level, CubeMapping mapping = CubeMapping::tangent);

/// The unit normal of lattice point (i, j), i and j in 0…n, of a patch divided n × n. Bit-exact
/// across levels, neighbours and faces: the same point of the sphere reached from any patch has the same bits.
[[nodiscard]] EcefDir patch_point(const PatchId& id, int i, int j, int n, CubeMapping mapping = CubeMapping::tangent);

/// True if the quads of a patch are split from (i, j) to (i+1, j+1) (paper 1, (2)): the patch lies in the 1st or 3rd
/// quadrant of its face. False in the 2nd and 4th. Level ≥ 1.
[[nodiscard]] bool forward_diagonal(const PatchId& id);

struct PatchIdHash {
  [[nodiscard]] std::size_t operator()(const PatchId& id) const;
};

}  // namespace terrella
