#pragma once

#include <glm/vec3.hpp>
#include <string_view>
#include <vector>

#include "base/result.h"

// thread: any, for all of this header
namespace terrella {

/// A fixed star.
struct Star {
  glm::vec3 direction_j2000;  ///< unit; mean equator and equinox of J2000, at that date: proper motion is left out
  float magnitude;            ///< visual magnitude
  glm::vec3 color_linear;     ///< linear sRGB, luminance 1
};

/// Reads data/sky/stars.csv. The heading names the columns; ra_deg, dec_deg, vmag and bv are read, in any order. Each
/// further line is a star. An empty bv means a white star. The error names the line and says what is wrong. thread: any
[[nodiscard]] Result<std::vector<Star>> parse_stars(std::string_view csv);

/// Returns the colour of a star for its B-V index, clamped to [-0.4, 2.5]. Ballesteros (2012,
/// doi:10.1209/0295-5075/97/34008) gives the temperature for the index. The colour is that of a black body, with the
/// chromaticity of Kim et al. (2002), US patent 7024034, which is within 0.002 of Planck's from 1667 K to 25000 K.
/// Linear sRGB, luminance 1, no component below 0. thread: any
[[nodiscard]] glm::vec3 star_color_linear(double bv);

}  // namespace terrella
