#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "geo/camera.h"
#include "geo/objects.h"

namespace terrella {

/// Characters of a label; a longer text ends in "…".
inline constexpr std::size_t kMostLabelCharacters = 96;
/// Returns the characters that a label shows of its text. thread: any
[[nodiscard]] std::u32string label_text(std::string_view utf8);

/// A box on the picture, pixels, y down.
struct LabelBox {
  glm::vec2 low_px, high_px;
};

/// The way from a place to its text, pixels.
struct TextWay {
  float near_px = 0.0F;  ///< right of the place: the nearer end of the text, or the middle of a centred one
  float side = 1.0F;     ///< 1 if the text goes on to the right from there, -1 to the left, 0 if it is centred
  float down_px = 0.0F;  ///< below the place: the middle of the line
};
/// Returns the way to a text that keeps a gap to a marker. The marker reaches `reach_px` around its place, the line
/// `half_height_px` over and under its middle. thread: any
[[nodiscard]] TextWay text_way(TextAnchor anchor, float reach_px, float half_height_px);

/// The space that labels occupy in a picture. The first label to claim a space gets it. thread: any, but one call at a
/// time
class LabelRoom {
 public:
  explicit LabelRoom(Viewport picture);
  /// True if a box is wholly in the picture and overlaps no claimed box.
  [[nodiscard]] bool is_free(const LabelBox& box) const;
  /// Claims a box. False if the box is not wholly in the picture, or overlaps a box claimed before.
  bool take(const LabelBox& box);
  /// Claims a box within the picture, even if it overlaps others.
  void claim(const LabelBox& box);

 private:
  template <class Visit>
  void each_cell(const LabelBox& box, const Visit& visit) const;

  Viewport picture_;
  int columns_, rows_;
  std::vector<std::vector<LabelBox>> cells_;  ///< per square of the picture, the boxes that touch it
};

/// True if an ellipsoid around the planet's centre hides or contains a point. The half axes are in metres; half axes of
/// 0 hide nothing. thread: any
[[nodiscard]] bool is_behind(const glm::dvec3& point_m, const glm::dvec3& eye_m, const glm::dvec3& half_axes_m);

/// True if a pixel shows the sky beside a planet, whose relief does not count. thread: any
[[nodiscard]] bool is_beside_planet(const View& view, const Ellipsoid& planet, const glm::dvec2& pixel_px);

}  // namespace terrella
