#pragma once

#include <glm/vec3.hpp>

namespace terrella {

/// A double position in two floats, as the GPU takes it: high + low is the position to 2⁻⁴⁸ of its size.
struct SplitPosition {
  glm::vec3 high;
  glm::vec3 low;
};
/// Splits a position. This is the one place where positions on the planet become floats. thread: any
[[nodiscard]] SplitPosition split_position(const glm::dvec3& p_m);

}  // namespace terrella
