#pragma once

#include <algorithm>
#include <cmath>
#include <glm/vec2.hpp>
#include <numbers>
#include <utility>

#include "objects/ground/ground_picture.h"

namespace terrella {

/// Pieces of shapes in the texels of a square's picture. Pieces are great circles, which are bent in face coordinates:
/// near the picture they are divided until no part is off by more than kBend_px.
class GroundEdges {
 public:
  GroundEdges(const FaceSquare& square, double around_px)
      : west_(square.west), south_(square.south), texels_(GroundPicture::kInner_px / square.side), around_(around_px) {}

  [[nodiscard]] glm::dvec2 texel(const glm::dvec2& p) const {
    return {(p.x - west_) * texels_ + GroundPicture::kRim_px, (p.y - south_) * texels_ + GroundPicture::kRim_px};
  }
  /// Most distance of pieces within a box from their chords, in texels.
  [[nodiscard]] double bend_px(const FaceBox& box) const {
    const double wide = box.east - box.west, high = box.north - box.south;
    return kBend * (wide * wide + high * high) * texels_;
  }
  /// Calls use(a, b), in texels, for the parts of a piece.
  template <class Use>
  void each(const glm::dvec2& a, const glm::dvec2& b, Use use, int depth = 0) const {
    const double length = std::hypot(b.x - a.x, b.y - a.y), bend_px = kBend * length * length * texels_;
    const glm::dvec2 p = texel(a), q = texel(b);
    if (bend_px <= kBend_px || depth >= kMostHalvings || is_beside(p, q, bend_px)) return use(p, q);
    const glm::dvec2 u = plane(a), v = plane(b);
    const glm::dvec2 middle(face(0.5 * (u.x + v.x)), face(0.5 * (u.y + v.y)));
    each(a, middle, use, depth + 1);
    each(middle, b, use, depth + 1);
  }

  /// The first and the last part of the way from a to b, in texels, that is near the picture. Empty: first >= last.
  [[nodiscard]] std::pair<double, double> inside(const glm::dvec2& a, const glm::dvec2& b) const {
    double first = 0.0, last = 1.0;
    const double least = -around_, most = GroundPicture::kSide_px + around_;
    for (int axis = 0; axis < 2; ++axis) {
      const double from = a[axis], way = b[axis] - from;
      if (way == 0.0) {
        if (from < least || from > most) return {1.0, 0.0};
        continue;
      }
      const double one = (least - from) / way, other = (most - from) / way;
      first = std::max(first, std::min(one, other));
      last = std::min(last, std::max(one, other));
    }
    return {first, last};
  }

 private:
  static constexpr double kBend_px = 0.1;
  static constexpr double kBend = 0.25;  ///< most distance of a piece from its chord, over the square of its length
  static constexpr int kMostHalvings = 24;

  [[nodiscard]] bool is_beside(const glm::dvec2& p, const glm::dvec2& q, double bend_px) const {
    const double most = GroundPicture::kSide_px + around_ + bend_px, least = -around_ - bend_px;
    return (p.x < least && q.x < least) || (p.y < least && q.y < least) || (p.x > most && q.x > most) ||
           (p.y > most && q.y > most);
  }
  static glm::dvec2 plane(const glm::dvec2& p) {
    return {std::tan(std::numbers::pi / 4.0 * p.x), std::tan(std::numbers::pi / 4.0 * p.y)};
  }
  static double face(double u) { return std::atan(u) * (4.0 / std::numbers::pi); }

  double west_, south_, texels_, around_;
};

}  // namespace terrella
