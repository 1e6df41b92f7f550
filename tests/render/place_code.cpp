#include "place_code.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace terrella::test {

PlaceCode::PlaceCode(const TileGrid& grid, const Ellipsoid& ellipsoid, const Geodetic& center, double half_extent)
    : grid_(grid), ellipsoid_(ellipsoid), half_extent_(half_extent) {
  const double lon = center.lon.rad();
  up_ = Ellipsoid::normal(center.lat, center.lon).xyz;
  east_ = {-std::sin(lon), std::cos(lon), 0.0};
  north_ = glm::cross(up_, east_);
}

Color PlaceCode::paint(double lon_deg, double row_deg) const {
  const glm::dvec3 n = Ellipsoid::normal(latitude_of_row(grid_, ellipsoid_, row_deg), Angle::degrees(lon_deg)).xyz;
  const auto level = [this](double part) {
    return static_cast<std::uint8_t>(std::lround(std::clamp(127.5 + 127.5 * part / half_extent_, 0.0, 255.0)));
  };
  // On the far side the components come back: there the scale ends.
  if (glm::dot(n, up_) < 0.0) return {0, 0, 255};
  return {level(glm::dot(n, east_)), level(glm::dot(n, north_)), 255};
}

std::optional<Ecef> PlaceCode::place(const Color& color) const {
  const auto near_end = [](int level) { return level < 3 || level > 252; };
  if (color[2] != 255 || near_end(color[0]) || near_end(color[1])) return std::nullopt;
  const double u = (color[0] - 127.5) / 127.5 * half_extent_, v = (color[1] - 127.5) / 127.5 * half_extent_;
  const double w = std::sqrt(std::max(0.0, 1.0 - u * u - v * v));
  return ellipsoid_.position(EcefDir{glm::normalize(u * east_ + v * north_ + w * up_)});
}

PlaceError place_error(const Picture& picture, const View& view, const Ellipsoid& ellipsoid, const PlaceCode& code) {
  std::vector<double> off_px;
  for (int y = 0; y < picture.size.height_px; ++y) {
    for (int x = 0; x < picture.size.width_px; ++x) {
      const auto place = code.place(picture.at(x, y));
      const glm::dvec2 center(x + 0.5, y + 0.5);
      if (!place || !pick(view, ellipsoid, center)) continue;
      const auto seen = project(view, *place);
      if (!seen) continue;
      off_px.push_back(glm::distance(*seen, center));
    }
  }
  if (off_px.empty()) return {};
  std::sort(off_px.begin(), off_px.end());
  return {off_px[off_px.size() * 99 / 100], static_cast<int>(off_px.size())};
}

}  // namespace terrella::test
