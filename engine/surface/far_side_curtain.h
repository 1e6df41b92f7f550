#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "geo/camera.h"
#include "geo/ellipsoid.h"

namespace terrella {

/// The curtain between the near side's underground and the far side's: the points where lines of sight are nearest to a
/// planet's centre. It holds the lines that pass between a sphere of `inner_radius_m` around the centre and the ground,
/// which lies at most -`lowest_m` (≤ 0) under the ellipsoid. A strip of triangles relative to the eye, metres, ECEF
/// axes. Its rings are the limbs of smaller and smaller ellipsoids. It stays under the ground by a pixel's width at the
/// limb, because the ground's own mesh may sag. Empty for an eye under the lowest ground. thread: any
[[nodiscard]] std::vector<glm::vec3> far_side_curtain(const View& view, const Ellipsoid& ellipsoid,
                                                      double inner_radius_m, double lowest_m);

/// Radius of the inner sphere. The depth under the equator is in metres of Earth and scales with the body. The radius
/// is at most 0.98 of the shortest axis. Source: paper 2, 2.1, where it is the equator's radius - 1000 km. thread: any
[[nodiscard]] double inner_sphere_radius_m(double a_m, double b_m, double below_m);

}  // namespace terrella
