#include "geo/split_position.h"

namespace terrella {

SplitPosition split_position(const glm::dvec3& p_m) {
  // volatile: GCC 12 at -O2 drops the conversion to float and back when it handles two components at a time. All lows
  // would be 0.
  volatile float x = static_cast<float>(p_m.x), y = static_cast<float>(p_m.y), z = static_cast<float>(p_m.z);
  const glm::vec3 high(x, y, z);
  return {high, glm::vec3(p_m - glm::dvec3(high))};
}

}  // namespace terrella
