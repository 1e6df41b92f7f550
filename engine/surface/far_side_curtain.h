#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "geo/camera.h"
#include "geo/ellipsoid.h"

namespace terrella {

/// The places where lines of sight are nearest to a planet's centre: before them lies the near side's underground, and
/// behind them the far side's. Of those lines that pass between a sphere of `inner_radius_m` around the centre and the
/// ground, which nowhere lies under the ellipsoid by more than -`lowest_m` (≤ 0). A strip of triangles relative to the
/// eye, metres, ECEF axes; they are rings, the limbs of smaller and smaller ellipsoids. It stays under the ground by a
/// pixel's width at the limb, which the ground's own mesh may sag. Empty for an eye under the lowest ground.
/// thread: any
[[nodiscard]] std::vector<glm::vec3> far_side_curtain(const View& view, const Ellipsoid& ellipsoid,
                                                      double inner_radius_m, double lowest_m);

/// Radius of the inner sphere: so far under the equator, in metres of Earth, scaled to the body and at most 0.98 of its
/// shortest axis. Source: paper 2, 2.1, where it is the equator's radius - 1000 km. thread: any
[[nodiscard]] double inner_sphere_radius_m(double a_m, double b_m, double below_m);

}  // namespace terrella
