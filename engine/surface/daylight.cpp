#include "surface/daylight.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "geo/scaled_space.h"

namespace terrella {

double part_shown(Daylight side, double sun_sine) {
  if (side == Daylight::both) return 1.0;
  const double t = std::clamp(sun_sine / kTwilightSine + 1.0, 0.0, 1.0);
  const double day = t * t * (3.0 - 2.0 * t);
  return side == Daylight::day ? day : 1.0 - day;
}

// A patch lies in a cone of scaled space. The normal at a point q has the direction of q over the axes. Its product
// with the Sun has the sign of the product of q with the Sun over the axes.
bool may_show(Daylight side, const PatchNode& patch, const Ellipsoid& ellipsoid, const glm::dvec3& sun) {
  if (side == Daylight::both) return true;
  const glm::dvec3 scaled_sun = sun / semi_axes_m(ellipsoid);
  const double length = glm::length(scaled_sun);
  const double c = std::clamp(glm::dot(patch.cone_axis, scaled_sun) / length, -1.0, 1.0);
  if (side == Daylight::night) return patch.cos_cone < 0.0 || c < patch.sin_cone;
  // If that product is negative, the sine is at most the product times the shorter axis.
  const double s = std::sqrt(1.0 - c * c);
  const double highest = c > patch.cos_cone ? 1.0 : c * patch.cos_cone + s * patch.sin_cone;
  return highest * length * std::min(ellipsoid.a_m(), ellipsoid.b_m()) > -kTwilightSine;
}

}  // namespace terrella
