#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "sky/sky_table.h"

namespace terrella {

/// The sky's colours at the vertices of a mesh around the eye's vertical, ready for the screen. Columns are azimuths
/// from the Sun, 0 to half a turn, both ends included. The first row lies behind the globe, so that no gap appears
/// beside it.
struct SkyColors {
  bool outside = false;
  int turn = 0;  ///< steps of the mesh all the way round
  int columns = 0, rows = 0;
  bool thin = false;                ///< few pixels high: rows are evenly apart in height, for one strip of triangles
  std::vector<glm::vec2> zenith{};  ///< sine and cosine of the angle from the zenith, one a row
  std::vector<glm::vec4> light_srgb{};  ///< columns a row; w unused
  std::vector<glm::vec4> through{};     ///< part of the background's stored colour that passes, one a row; w unused
  /// Air beside the limb, summed from the limb outwards in steps of a pixel's kLimbSteps-th part: `columns` a row, and
  /// one a row. Empty from inside the air, where the air is many pixels thick.
  std::vector<glm::vec4> limb_light_sum{}, limb_through_sum{};
  static constexpr int kLimbSteps = 16, kLimbRows = 49;
};

/// Computes the colours. From outside, `pixel` is the height over the limb that a pixel covers, in radii: the colours
/// are means over a pixel, and the part of a pixel that is over the globe counts as black. Ground that lies `below` the
/// limb, in radii, leaves more of the sky open: the limb's colour then goes on down there. thread: any
[[nodiscard]] SkyColors make_sky_colors(const AirTables& air, const AirEye& eye, double pixel, double below = 0.0);

/// The air before the ground, as two factors: squares of stored colours are multiplied by `through`, and `light_sq` is
/// added. Squares stand for light, as if the screen's gamma were 2. A picture of the ground is what a satellite sees
/// through the air, so an eye that looks straight down sees the picture's own colours. Only air beyond 1.2 times the
/// air under the eye changes them. If t of the ground's light passes, and t0 through that air, then min(1, t / t0) = t'
/// of the picture is left, and the air's light counts by (1 - t') / (1 - t). Light adds up as on film: 1 - exp(-x). The
/// light on the ground has a colour of its own, red beside the terminator: a third factor of the squares, whose
/// greatest channel is 1. Its red and green shares of its sum are the w of `through` and of `light_sq`. thread: any
struct GroundColors {
  static constexpr int kColumns = 32;  ///< azimuths from the Sun, 0 to half a turn, both ends included
  /// Cosines m between the ray and the ground's vertical, by sqrt(1 - sqrt(1 - m)): 0 at the horizon, 1 at the nadir.
  static constexpr int kRows = 32;
  std::vector<glm::vec4> through, light_sq;  ///< kColumns a row
};
[[nodiscard]] GroundColors make_ground_colors(const AirTables& air, const AirEye& eye);

}  // namespace terrella
