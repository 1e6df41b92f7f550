#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "objects/ground/ground_edges.h"

namespace terrella {

/// The nearest line of each texel. Of lines that cover the middle of a texel the last one counts.
class GroundLines {
 public:
  struct Best {
    float away = 1e9F, over = 1e9F;  ///< distance to the line's middle; to its side, or 0
    float distance = 0.0F;           ///< signed, along `direction`
    glm::vec2 direction{1.0F, 0.0F};
    std::uint32_t color = 0, width = 0, owner = 0;
  };
  using Memory = std::vector<Best>;

  /// Texels keep lines up to `reach_px` away.
  GroundLines(const FaceSquare& square, double reach_px, Memory& memory)
      : edges_(square, reach_px), reach_(reach_px), best_(memory) {
    best_.clear();
  }

  void add(const GroundPart& part, const GroundObject& object);
  /// Empty if no line is within reach.
  [[nodiscard]] std::vector<glm::uvec2> take() const;

 private:
  void piece(glm::dvec2 a, glm::dvec2 b);

  GroundEdges edges_;
  double reach_;
  float half_width_ = 0.0F;
  std::uint32_t color_ = 0, width_ = 0, owner_ = 0;
  Memory& best_;
};

}  // namespace terrella
