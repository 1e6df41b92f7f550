#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "objects/ground/ground_edges.h"

namespace terrella {

/// The lines of each texel: the last of those that a pixel there may show, and the one below it if its colour is
/// another. Without these, the nearest line. Of lines of one colour the one that reaches furthest over the texel
/// counts.
class GroundLines {
 public:
  struct Line {
    float away = 0.0F, over = 0.0F;  ///< distance to the line's middle; to its side, or 0
    float distance = 0.0F;           ///< signed, along `direction`
    glm::vec2 direction{1.0F, 0.0F};
    std::uint32_t color = 0;
    float half_width_px = 0.0F;
    std::uint32_t owner = 0;  ///< 0: none
    bool is_end = false;      ///< the nearest point is an end of a piece
  };
  struct Texel {
    Line top, below;
  };
  using Memory = std::vector<Texel>;

  /// Texels keep lines up to `reach_px` away. `stretch`: pixels are at most that many texels long.
  GroundLines(const FaceSquare& square, double reach_px, double stretch, Memory& memory)
      : edges_(square, reach_px), reach_(reach_px), stretch_(static_cast<float>(stretch)), texels_(memory) {
    texels_.clear();
  }

  void add(const GroundPart& part, const GroundObject& object);
  /// Sets `line` and `crossed` of a picture.
  void take(GroundPicture& picture) const;

 private:
  void piece(glm::dvec2 a, glm::dvec2 b);
  void offer(const Line& line, Texel& texel) const;
  /// True if a pixel whose middle is in the texel may show the line.
  [[nodiscard]] bool may_show(const Line& line) const {
    return line.owner != 0 && line.away <= (line.half_width_px + kBesideMiddle_px) * stretch_;
  }
  [[nodiscard]] std::uint32_t code(const Line& line) const;
  static constexpr float kBesideMiddle_px = 0.75F;

  GroundEdges edges_;
  double reach_;
  float stretch_;
  float half_width_ = 0.0F;
  std::uint32_t color_ = 0, owner_ = 0;
  glm::dvec2 last_end_{-1e9}, last_way_{0.0};  ///< end and direction of the last piece
  Memory& texels_;
};

}  // namespace terrella
