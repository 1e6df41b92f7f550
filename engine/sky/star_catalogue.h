#pragma once

#include <glm/vec3.hpp>
#include <string_view>
#include <vector>

#include "base/result.h"

// thread: any, for all of this header
namespace terrella {

/// A fixed star.
struct Star {
  glm::vec3
      direction_j2000;     ///< unit; mean equator and equinox of J2000, as of that date: motion of its own is left out
  float magnitude;         ///< visual
  glm::vec3 color_linear;  ///< linear sRGB, luminance 1
};

/// Reads data/sky/stars.csv: a heading that names the columns, of which ra_deg, dec_deg, vmag and bv are read, in any
/// order; then a star a line. An empty bv stands for a white star. The error names the line and what is wrong with it.
/// thread: any
[[nodiscard]] Result<std::vector<Star>> parse_stars(std::string_view csv);

/// Colour of a star by its B-V index, [-0.4, 2.5], clamped to it: the black body of the temperature that Ballesteros
/// (2012, doi:10.1209/0295-5075/97/34008) gives for the index, its chromaticity after Kim et al. (2002), US patent
/// 7024034, which is within 0.002 of Planck's from 1667 K to 25000 K. Linear sRGB, luminance 1, no part below 0.
[[nodiscard]] glm::vec3 star_color_linear(double bv);

}  // namespace terrella
