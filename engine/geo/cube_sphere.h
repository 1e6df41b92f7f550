#pragma once

#include <array>

#include "geo/coordinates.h"

// thread: any, for all of this header
// Paper 1: A. Zuev, "Method of synthesis of a seamless textured sphere for visualization in geoinformation and
// cartographic systems", 2023.
namespace terrella {

/// Cube faces, named by their axis. The centres of the equatorial faces are at 0°, 90°, 180° and 270° E.
enum class CubeFace : int { pos_x = 0, pos_y = 1, neg_x = 2, neg_y = 3, pos_z = 4, neg_z = 5 };
inline constexpr int kCubeFaces = 6;

/// The mapping from face coordinates to the sphere. `plain` is paper 1's formula (1): normalise N + s i T + t j B. The
/// areas of the patches of one level then vary by 5.2 to 1. `tangent` first warps each coordinate by tan(π/4 · x), and
/// the areas vary by 1.4 to 1.
enum class CubeMapping { plain, tangent };

/// The frame of a face: N is its axis, T the direction of +i, B the direction of +j, and T × B = N. Seen from outside,
/// i runs right and j runs up.
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

/// Returns the unit vector of a face point: paper 1, formula (1), with i and j in [-1, 1].
///
/// Watertight seams depend on these bit-exact promises. The value depends only on |i|, |j| and the signs (odd
/// functions). At i = ±1 or j = ±1, both faces that share the edge or corner give the same bits. i = 0 and j = 0 give
/// exact zeros. Equatorial faces have T = ±x or ±y and B = +z. thread: any
[[nodiscard]] EcefDir cube_to_sphere(const FacePoint& p, CubeMapping mapping = CubeMapping::tangent);

/// Returns the face point of a direction, on the face of its largest component (ties: x before y before z). Error ≤
/// 4e-16 in i and j. thread: any
[[nodiscard]] FacePoint sphere_to_cube(const EcefDir& direction, CubeMapping mapping = CubeMapping::tangent);

}  // namespace terrella
