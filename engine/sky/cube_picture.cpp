#include "sky/cube_picture.h"

#include <algorithm>
#include <cmath>
#include <glm/vec3.hpp>
#include <numbers>

namespace terrella {
namespace {

// The OpenGL specification's table of cube map faces, solved for the direction; s and t in -1...1, t down the rows.
glm::dvec3 face_direction(int face, double s, double t) {
  switch (face) {
    case 0:
      return {1.0, -t, -s};
    case 1:
      return {-1.0, -t, s};
    case 2:
      return {s, 1.0, t};
    case 3:
      return {s, -1.0, -t};
    case 4:
      return {s, -t, 1.0};
    default:
      return {-s, -t, -1.0};
  }
}

// Columns wrap around, rows end at the poles.
double map_value(const GreyPicture& map, const glm::dvec3& d) {
  const double lon = std::atan2(d.y, d.x), lat = std::atan2(d.z, std::hypot(d.x, d.y));
  const double x = (lon / (2.0 * std::numbers::pi) + 0.5) * map.width_px - 0.5;
  const double y = std::clamp((0.5 - lat / std::numbers::pi) * map.height_px - 0.5, 0.0, map.height_px - 1.0);
  const double left = std::floor(x), top = std::floor(y);
  const auto value = [&map](int column, int row) {
    const int wrapped = (column % map.width_px + map.width_px) % map.width_px;
    return double(
        map.values[static_cast<std::size_t>(std::min(row, map.height_px - 1)) * static_cast<std::size_t>(map.width_px) +
                   static_cast<std::size_t>(wrapped)]);
  };
  const int column = static_cast<int>(left), row = static_cast<int>(top);
  const double upper = std::lerp(value(column, row), value(column + 1, row), x - left);
  const double lower = std::lerp(value(column, row + 1), value(column + 1, row + 1), x - left);
  return std::lerp(upper, lower, y - top);
}

}  // namespace

std::array<std::vector<std::uint8_t>, 6> cube_faces(const GreyPicture& map, int side_px) {
  std::array<std::vector<std::uint8_t>, 6> faces;
  if (map.width_px < 1 || map.height_px < 1) return faces;
  for (int face = 0; face < 6; ++face) {
    std::vector<std::uint8_t>& texels = faces[static_cast<std::size_t>(face)];
    texels.reserve(static_cast<std::size_t>(side_px) * static_cast<std::size_t>(side_px));
    for (int row = 0; row < side_px; ++row) {
      for (int column = 0; column < side_px; ++column) {
        const double s = (2 * column + 1.0) / side_px - 1.0, t = (2 * row + 1.0) / side_px - 1.0;
        texels.push_back(static_cast<std::uint8_t>(map_value(map, face_direction(face, s, t)) + 0.5));
      }
    }
  }
  return faces;
}

}  // namespace terrella
