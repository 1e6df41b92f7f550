#pragma once

#include <glm/vec2.hpp>
#include <vector>

#include "geo/camera.h"
#include "geo/ellipsoid.h"

namespace terrella {

/// A corner of the ribbon along the globe's limb: where it is on the screen and how far outside the limb.
struct LimbVertex {
  glm::vec2 position_ndc;  ///< normalised device coordinates, +y up
  glm::vec2 outward_px;    ///< unit vector in pixels, +y up, away from the disc
  float distance_px;       ///< signed, positive outside
};

/// A strip of triangles along the part of the limb that is in view, `half_width_px` to either side; empty where there
/// is none (eye on or under the surface, limb out of view). Breaks are marked by repeated vertices. The limb of an
/// ellipsoid is the plane section whose points q in scaled space satisfy q · eye = 1. Error ≤ 0.02 px.
/// thread: any
[[nodiscard]] std::vector<LimbVertex> limb_ribbon(const View& view, const Ellipsoid& ellipsoid, double half_width_px);

}  // namespace terrella
