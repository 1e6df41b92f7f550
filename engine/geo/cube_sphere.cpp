#include "geo/cube_sphere.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace terrella {
namespace {

// Each polar face continues the face at 0° E, so T is +y on all three.
constexpr std::array<CubeFaceFrame, kCubeFaces> kFrames = {{
    {.n = {1, 0, 0}, .t = {0, 1, 0}, .b = {0, 0, 1}},
    {.n = {0, 1, 0}, .t = {-1, 0, 0}, .b = {0, 0, 1}},
    {.n = {-1, 0, 0}, .t = {0, -1, 0}, .b = {0, 0, 1}},
    {.n = {0, -1, 0}, .t = {1, 0, 0}, .b = {0, 0, 1}},
    {.n = {0, 0, 1}, .t = {0, 1, 0}, .b = {-1, 0, 0}},
    {.n = {0, 0, -1}, .t = {0, 1, 0}, .b = {1, 0, 0}},
}};

/// Odd by construction, and exactly ±1 at ±1, where tan(π/4) in double is one ulp short.
double warp(double x, CubeMapping mapping) {
  if (mapping == CubeMapping::plain || x == 0.0) return x;
  const double magnitude = std::abs(x);
  return magnitude == 1.0 ? x : std::copysign(std::tan(std::numbers::pi / 4.0 * magnitude), x);
}

double unwarp(double x, CubeMapping mapping) {
  if (mapping == CubeMapping::plain || x == 0.0) return x;
  const double magnitude = std::abs(x);
  return magnitude == 1.0 ? x : std::copysign(std::min(std::atan(magnitude) * (4.0 / std::numbers::pi), 1.0), x);
}

CubeFace face_of(const glm::dvec3& d) {
  const glm::dvec3 size(std::abs(d.x), std::abs(d.y), std::abs(d.z));
  if (size.x >= size.y && size.x >= size.z) return d.x < 0.0 ? CubeFace::neg_x : CubeFace::pos_x;
  if (size.y >= size.z) return d.y < 0.0 ? CubeFace::neg_y : CubeFace::pos_y;
  return d.z < 0.0 ? CubeFace::neg_z : CubeFace::pos_z;
}

}  // namespace

const CubeFaceFrame& face_frame(CubeFace face) { return kFrames.at(static_cast<std::size_t>(face)); }

EcefDir cube_to_sphere(const FacePoint& p, CubeMapping mapping) {
  const CubeFaceFrame& frame = face_frame(p.face);
  // The frames contain only 0 and ±1, so this sum is exact, and two faces get the same bits for a shared cube point.
  // The zeros of N are +0, and +0 plus a zero of either sign is +0. So no -0 arises that would turn 180° into -180°.
  const glm::dvec3 on_cube = frame.n + warp(p.i, mapping) * frame.t + warp(p.j, mapping) * frame.b;
  // All faces add x, y, z in this order, so that rounding does not depend on the axis of the face.
  const double length = std::sqrt(on_cube.x * on_cube.x + on_cube.y * on_cube.y + on_cube.z * on_cube.z);
  return EcefDir{on_cube / length};
}

FacePoint sphere_to_cube(const EcefDir& direction, CubeMapping mapping) {
  const CubeFace face = face_of(direction.xyz);
  const CubeFaceFrame& frame = face_frame(face);
  const double depth = glm::dot(direction.xyz, frame.n);
  return {.face = face,
          .i = unwarp(glm::dot(direction.xyz, frame.t) / depth, mapping),
          .j = unwarp(glm::dot(direction.xyz, frame.b) / depth, mapping)};
}

}  // namespace terrella
