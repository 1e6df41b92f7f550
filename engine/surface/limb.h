#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
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

/// Pixels this far inside the limb belong to it: further inside, the ends of a pixel's footprint are off by a twentieth
/// of a pixel if it is taken for straight.
inline constexpr double kLimb_px = 1.0;

/// The square of the cosine between a pixel's ray and the ellipsoid's normal where they meet, by the place in the
/// picture. It is 0 on the limb, grows evenly with the distance inside the limb, and is less than 0 outside.
struct LimbSquare {
  glm::dvec2 at_px;  ///< a place on the limb, if one is found, from the picture's lower left corner, +y up
  double there;      ///< the square there
  glm::dvec2 slope;  ///< its change per pixel there
  glm::dvec3 bend;   ///< changes of the slope: factors of x², xy and y², x and y in pixels from `at_px`
  /// At a place `px`. The sum is the square times that of the ray's length over its part along the view's axis.
  [[nodiscard]] double times_length_sq(glm::dvec2 px) const;
};

/// Fits a square to a view; none for an eye on or under the surface. Error ≤ 1e-9. thread: any
[[nodiscard]] std::optional<LimbSquare> limb_square(const View& view, const Ellipsoid& ellipsoid);

/// The ring of the unit sphere, in scaled space, that lies up to kLimb_px inside the limb of a view, and as far behind
/// it. A plain value. thread: any
class LimbRing {
 public:
  /// Holds nothing for an eye on or under the surface.
  LimbRing(const View& view, const Ellipsoid& ellipsoid);

  /// True if a cone around `axis`, a unit vector, may reach into the ring.
  [[nodiscard]] bool meets(const glm::dvec3& axis, double cos_half_angle, double sin_half_angle) const;
  /// True if a point on the sphere lies in the ring.
  [[nodiscard]] bool holds(const glm::vec3& point) const;

 private:
  glm::dvec3 towards_eye_{0.0};
  glm::dvec2 begin_{0.0}, end_{0.0};  ///< cosine and sine of the angles from towards_eye_
};

}  // namespace terrella
