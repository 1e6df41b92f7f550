#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace terrella {

/// A picture with one value per pixel, rows from the top. A map is equirectangular, its top at 90°N, its left at 180°W.
struct GreyPicture {
  int width_px = 0;
  int height_px = 0;
  std::vector<std::uint8_t> values;  ///< width · height
};

/// Converts a map of the whole planet to six faces of a cube, in OpenGL's order and orientation (+x, -x, +y, -y, +z, -z
/// of ECEF). Looking up by direction has no seam at the antimeridian and no pole. `side_px` is the side of a face, at
/// least 1. A quarter of the map's width keeps the map's detail, except for a loss of 20 % in the middle of a face.
/// Bilinear. thread: any
[[nodiscard]] std::array<std::vector<std::uint8_t>, 6> cube_faces(const GreyPicture& map, int side_px);

}  // namespace terrella
