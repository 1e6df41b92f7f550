#pragma once

#include <array>

#include "geo/coordinates.h"

// thread: any, for all of this header
namespace terrella {

/// Cube faces by the axis that they look along. Equatorial faces centre on 0°, 90°, 180°, 270° E.
enum class CubeFace : int { pos_x = 0, pos_y = 1, neg_x = 2, neg_y = 3, pos_z = 4, neg_z = 5 };
inline constexpr int kCubeFaces = 6;

/// How face coordinates spread over the sphere. `plain` is paper 1's formula (1): normalise N + s i T + t j B; the
/// patches of one level differ 5.2 to 1 in area. `tangent` first warps each coordinate by tan(π/4 · x): 1.4 to 1.
enum class CubeMapping { plain, tangent };

/// The frame of a face: N its axis, T the direction of +i, B of +j; T × B = N (seen from outside, i runs right
/// and j runs up).
struct CubeFaceFrame {
  glm::dvec3 n, t, b;
};
[[nodiscard]] const CubeFaceFrame& face_frame(CubeFace face);

/// Face coordinates, both in [-1, 1].
struct FacePoint {
  CubeFace face;
  double i;
  double j;
};

/// The unit vector of a face point: paper 1, (1), with i, j in -1…1.
///
/// Bit-exact promises, on which watertight seams rest: the value depends on |i|, |j| and signs only (odd functions);
/// i = ±1 or j = ±1 give the same bits from both faces that share the edge or corner; i = 0 and j = 0 give exact
/// zeros. Equatorial faces have T = ±x or ±y and B = +z.
[[nodiscard]] EcefDir cube_to_sphere(const FacePoint& p, CubeMapping mapping = CubeMapping::tangent);

/// The face point of a direction: the face of the largest component (ties: x before y before z).
/// Error ≤ 4e-16 in i and j.
[[nodiscard]] FacePoint sphere_to_cube(const EcefDir& direction, CubeMapping mapping = CubeMapping::tangent);

}  // namespace terrella
