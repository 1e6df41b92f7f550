#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace terrella {

/// One value a pixel, rows from the top. As a map: equirectangular, the top at 90°N, the left at 180°W.
struct GreyPicture {
  int width_px = 0;
  int height_px = 0;
  std::vector<std::uint8_t> values;  ///< width · height
};

/// A map of the whole planet as six faces of a cube, in OpenGL's order and orientation (+x, -x, +y, -y, +z, -z of
/// ECEF), looked up by direction: without a seam at the antimeridian and without a pole. `side_px` a face's side, at
/// least 1; a quarter of the map's width keeps its detail but for a fifth in the middle of a face. Bilinear. thread:
/// any
[[nodiscard]] std::array<std::vector<std::uint8_t>, 6> cube_faces(const GreyPicture& map, int side_px);

}  // namespace terrella
