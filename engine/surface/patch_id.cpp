#include "surface/patch_id.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>

#include "base/hash_mix.h"

namespace terrella {
namespace {

CubeFace face_along(const glm::dvec3& axis) {
  int face = 0;
  while (face_frame(static_cast<CubeFace>(face)).n != axis) ++face;
  return static_cast<CubeFace>(face);
}

/// The axis that points out of a face across a side: N of the face there.
glm::dvec3 side_axis(const CubeFaceFrame& frame, PatchSide side) {
  switch (side) {
    case PatchSide::west:
      return -frame.t;
    case PatchSide::east:
      return frame.t;
    case PatchSide::south:
      return -frame.b;
    case PatchSide::north:
      break;
  }
  return frame.b;
}

/// Across a cube edge. Cell centres are counted in half cells from the face's centre, so all numbers are integers far
/// below 2^53 and exact: a cell that touches the edge lies at cells - 1 along the axis that it came from.
PatchId neighbour_on_next_face(const PatchId& id, PatchSide side) {
  const CubeFaceFrame& from = face_frame(id.face);
  const glm::dvec3 axis = side_axis(from, side);
  const double cells = std::ldexp(1.0, id.level);
  const bool crosses_in_i = side == PatchSide::west || side == PatchSide::east;
  const glm::dvec3 along = crosses_in_i ? from.b : from.t;
  const double position = 2.0 * (crosses_in_i ? id.y : id.x) + 1.0 - cells;
  const glm::dvec3 centre = axis * cells + from.n * (cells - 1.0) + along * position;

  const CubeFace face = face_along(axis);
  const CubeFaceFrame& to = face_frame(face);
  const auto cell = [&](const glm::dvec3& direction) {
    return static_cast<std::uint32_t>((glm::dot(centre, direction) + cells - 1.0) / 2.0);
  };
  return {.face = face, .level = id.level, .x = cell(to.t), .y = cell(to.b)};
}

/// -1 + 2 (cell + k/n) / 2^level as one quotient of whole numbers, so that the same point has the same bits at every
/// level and, mirrored, on every face, also where n is no power of two.
double face_coordinate(std::uint32_t cell, int k, int n, int level) {
  const double across = std::ldexp(static_cast<double>(n), level);
  return (2.0 * (static_cast<double>(cell) * n + k) - across) / across;
}

std::uint32_t cell_at(double coordinate, int level) {
  const double last = std::ldexp(1.0, level) - 1.0;
  const double cell = std::floor(std::ldexp(coordinate + 1.0, level - 1));
  // Written so that NaN falls into cell 0: converting it to an integer would be undefined.
  return cell > 0.0 ? static_cast<std::uint32_t>(std::min(cell, last)) : 0U;
}

}  // namespace

PatchId parent(const PatchId& id) {
  assert(id.level >= 1);
  return {.face = id.face, .level = id.level - 1, .x = id.x / 2, .y = id.y / 2};
}

std::array<PatchId, 4> children(const PatchId& id) {
  assert(id.level < kMaxPatchLevel);
  const auto child = [&](std::uint32_t dx, std::uint32_t dy) {
    return PatchId{.face = id.face, .level = id.level + 1, .x = 2 * id.x + dx, .y = 2 * id.y + dy};
  };
  return {child(0, 0), child(1, 0), child(0, 1), child(1, 1)};
}

PatchId neighbour(const PatchId& id, PatchSide side) {
  const std::uint32_t last = (1U << id.level) - 1U;
  PatchId next = id;
  switch (side) {
    case PatchSide::west:
      if (id.x == 0) return neighbour_on_next_face(id, side);
      --next.x;
      break;
    case PatchSide::east:
      if (id.x == last) return neighbour_on_next_face(id, side);
      ++next.x;
      break;
    case PatchSide::south:
      if (id.y == 0) return neighbour_on_next_face(id, side);
      --next.y;
      break;
    case PatchSide::north:
      if (id.y == last) return neighbour_on_next_face(id, side);
      ++next.y;
      break;
  }
  return next;
}

bool contains(const PatchId& ancestor, const PatchId& id) {
  if (ancestor.face != id.face || ancestor.level > id.level) return false;
  const int steps = id.level - ancestor.level;
  return id.x >> steps == ancestor.x && id.y >> steps == ancestor.y;
}

PatchId patch_at(const EcefDir& normal, int level, CubeMapping mapping) {
  assert(level >= 0 && level <= kMaxPatchLevel);
  const FacePoint p = sphere_to_cube(normal, mapping);
  return {.face = p.face, .level = level, .x = cell_at(p.i, level), .y = cell_at(p.j, level)};
}

EcefDir patch_point(const PatchId& id, int i, int j, int n, CubeMapping mapping) {
  assert(n > 0);
  return cube_to_sphere(
      {.face = id.face, .i = face_coordinate(id.x, i, n, id.level), .j = face_coordinate(id.y, j, n, id.level)},
      mapping);
}

bool forward_diagonal(const PatchId& id) {
  assert(id.level >= 1);
  const int to_quadrant = id.level - 1;
  return id.x >> to_quadrant == id.y >> to_quadrant;
}

std::size_t PatchIdHash::operator()(const PatchId& id) const {
  // 3 + 5 + 28 + 28 bits hold every valid id, so different patches never share a hash.
  const std::uint64_t packed = static_cast<std::uint64_t>(id.face) << 61 | static_cast<std::uint64_t>(id.level) << 56 |
                               static_cast<std::uint64_t>(id.x) << 28 | id.y;
  return mix_bits(packed);
}

}  // namespace terrella
