#pragma once

#include <glm/vec3.hpp>

namespace terrella {

/// A double position as two floats, for the GPU. high + low equals the position to 2⁻⁴⁸ of its size.
struct SplitPosition {
  glm::vec3 high;
  glm::vec3 low;
};
/// Splits a position. Positions on the planet become floats only here. thread: any
[[nodiscard]] SplitPosition split_position(const glm::dvec3& p_m);

}  // namespace terrella
