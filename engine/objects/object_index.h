#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "objects/pick_cone.h"

namespace terrella {

/// Finds the objects near a ray: a loose octree of balls around them. A ball lies in a cube that holds its centre and
/// is at least as wide as the ball. Cubes with many balls are divided. thread: any, but one call at a time
class ObjectIndex {
 public:
  ObjectIndex();
  /// Adds an object, or moves it. Costs little if it stays in its cube.
  void put(std::uint32_t item, const Ball& ball);
  void remove(std::uint32_t item);
  /// Appends the objects whose balls a cone meets, in any order.
  void find(const PickCone& cone, std::vector<std::uint32_t>& items) const;

 private:
  static constexpr std::uint32_t kNone = ~0U;
  struct Node {
    glm::dvec3 center_m;
    double half_m;
    std::uint32_t first_child = kNone;  ///< the first of eight
    std::vector<std::uint32_t> items = {};
  };
  struct Entry {
    Ball ball;
    std::uint32_t node = kNone, at = 0;  ///< the node, and the index in its items
  };
  [[nodiscard]] static bool holds(const Node& node, const Ball& ball);
  [[nodiscard]] std::uint32_t node_for(const Ball& ball) const;
  void take_out(const Entry& entry);
  void divide(std::uint32_t node);

  std::vector<Node> nodes_;  ///< the root also has the balls that lie outside of its cube
  std::vector<Entry> entries_;
};

}  // namespace terrella
