#pragma once

#include <cstdint>
#include <numbers>
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
    float away = 0.0F, over = 0.0F;  ///< distance to the line's middle; to its side, below 0 within it
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
      : edges_(square, reach_px),
        texel_rad_(0.25 * std::numbers::pi * square.side / GroundPicture::kInner_px),
        reach_(reach_px),
        stretch_(static_cast<float>(stretch)),
        texels_(memory) {
    texels_.clear();
  }

  void add(const GroundPart& part, const GroundObject& object);
  void add_casing(const GroundPart& part, const GroundObject& object);
  /// Returns the lines on top. Empty: there are none.
  [[nodiscard]] LineSheet top() const;
  /// Returns the lines that show below those on top. Empty: there are none.
  [[nodiscard]] LineSheet below() const;

 private:
  void add_way(const GroundPart& part, ObjectColor color, float width_px, const LineDashes& dashes);
  void add_run(const GroundPart& part, const GroundRun& run, const LineDashes& dashes);
  void dashed(const glm::dvec2& a, const glm::dvec2& b, double from_rad, double to_rad, const LineDashes& dashes);
  void piece(glm::dvec2 a, glm::dvec2 b);
  void offer(const Line& line, Texel& texel) const;
  /// True if a pixel whose middle is in the texel may show the line.
  [[nodiscard]] bool may_show(const Line& line) const {
    return line.owner != 0 && line.away <= (line.half_width_px + kBesideMiddle_px) * stretch_;
  }
  [[nodiscard]] std::uint32_t code(const Line& line) const;
  /// Returns the lines that pick(texel) points to; null: none there.
  template <class Pick>
  [[nodiscard]] LineSheet sheet(Pick pick) const;
  static constexpr float kBesideMiddle_px = 0.75F;

  GroundEdges edges_;
  double texel_rad_;  ///< about the angle that a texel spans
  double reach_;
  float stretch_;
  float half_width_ = 0.0F;
  std::uint32_t color_ = 0, owner_ = 0;
  glm::dvec2 last_end_{-1e9}, last_way_{0.0};  ///< end and direction of the last piece
  Memory& texels_;
};

}  // namespace terrella
