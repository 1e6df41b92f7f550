#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "geo/camera.h"

namespace terrella {

/// Code points of a UTF-8 text; U+FFFD for each byte that begins none. thread: any
[[nodiscard]] std::u32string code_points(std::string_view utf8);

/// A box on the picture, pixels, y down.
struct LabelBox {
  glm::vec2 low_px, high_px;
};

/// The room that labels take on a picture, first come, first served. thread: one
class LabelRoom {
 public:
  explicit LabelRoom(Viewport picture);
  /// Takes a box if all of it lies in the picture and none before it overlaps it.
  bool take(const LabelBox& box);

 private:
  Viewport picture_;
  int columns_, rows_;
  std::vector<std::vector<LabelBox>> cells_;  ///< the boxes that touch each square of the picture
};

/// Whether an ellipsoid around the planet's centre with these half axes, metres, stands between the eye and a point, or
/// holds it. Half axes of 0 hide nothing. thread: any
[[nodiscard]] bool is_behind(const glm::dvec3& point_m, const glm::dvec3& eye_m, const glm::dvec3& half_axes_m);

}  // namespace terrella
