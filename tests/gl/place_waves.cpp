#include "tests/gl/place_waves.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat2x2.hpp>
#include <glm/matrix.hpp>
#include <numbers>
#include <optional>

namespace terrella::test {
namespace {

constexpr double kMean = 127.5, kAmplitude = 120.0;
constexpr std::array<double, 3> kPeriods_px = {19.0, 23.0, 27.0};
// Levels a pixel: under the least, rounding blurs the place; over the most, a wave is shorter than the filters allow.
constexpr double kLeastSlope = 12.0, kMostSlope = 70.0;

class Judge {
 public:
  Judge(const View& view, const Ellipsoid& ellipsoid, const PlaceWaves& waves)
      : view_(view), ellipsoid_(ellipsoid), waves_(waves) {}

  /// Offset of the place that a pixel's colour shows, relative to the pixel: least squares over the three channels;
  /// nothing if they say too little.
  [[nodiscard]] std::optional<glm::dvec2> offset_px(const Color& color, glm::dvec2 px) const {
    const auto here = at(px), east = at(px + glm::dvec2(0.5, 0.0)), west = at(px - glm::dvec2(0.5, 0.0)),
               south = at(px + glm::dvec2(0.0, 0.5)), north = at(px - glm::dvec2(0.0, 0.5));
    if (!here || !east || !west || !south || !north) return std::nullopt;
    glm::dmat2 normal(0.0);
    glm::dvec2 right(0.0);
    for (std::size_t k = 0; k < 3; ++k) {
      const glm::dvec2 slope((*east)[k] - (*west)[k], (*south)[k] - (*north)[k]);
      const double difference = color[k] - (*here)[k];
      if (glm::length(slope) > kMostSlope) return std::nullopt;
      normal += glm::outerProduct(slope, slope);
      right += slope * difference;
    }
    const double half_trace = 0.5 * (normal[0][0] + normal[1][1]);
    const double least = half_trace - std::sqrt(std::max(0.0, half_trace * half_trace - glm::determinant(normal)));
    if (least < kLeastSlope * kLeastSlope) return std::nullopt;
    return glm::inverse(normal) * right;
  }

 private:
  [[nodiscard]] std::optional<std::array<double, 3>> at(glm::dvec2 px) const {
    const auto place = pick(view_, ellipsoid_, px);
    if (!place) return std::nullopt;
    return waves_.levels(Ellipsoid::normal(place->lat, place->lon));
  }

  const View& view_;
  const Ellipsoid& ellipsoid_;
  const PlaceWaves& waves_;
};

}  // namespace

PlaceWaves::PlaceWaves(const TileGrid& grid, const Ellipsoid& ellipsoid, const Geodetic& center, double pixel)
    : grid_(grid), ellipsoid_(ellipsoid) {
  const double lon = center.lon.rad();
  up_ = Ellipsoid::normal(center.lat, center.lon).xyz;
  const glm::dvec3 east(-std::sin(lon), std::cos(lon), 0.0), north = glm::cross(up_, east);
  for (std::size_t k = 0; k < 3; ++k) {
    const double turn = (0.1 + static_cast<double>(k) / 3.0) * 2.0 * std::numbers::pi;
    wave_[k] = 2.0 * std::numbers::pi / (kPeriods_px[k] * pixel) * (std::cos(turn) * east + std::sin(turn) * north);
  }
}

std::array<double, 3> PlaceWaves::levels(const EcefDir& normal) const {
  std::array<double, 3> level{};
  // From the centre, for the digits.
  const glm::dvec3 d = normal.xyz - up_;
  for (std::size_t k = 0; k < 3; ++k) level[k] = kMean + kAmplitude * std::sin(glm::dot(d, wave_[k]));
  return level;
}

Color PlaceWaves::paint(double lon_deg, double row_deg) const {
  const auto level = levels(Ellipsoid::normal(latitude_of_row(grid_, ellipsoid_, row_deg), Angle::degrees(lon_deg)));
  Color color{};
  for (std::size_t k = 0; k < 3; ++k) color[k] = static_cast<std::uint8_t>(std::lround(level[k]));
  return color;
}

WaveError wave_error(const Picture& picture, const View& view, const Ellipsoid& ellipsoid, const PlaceWaves& waves) {
  const Judge judge(view, ellipsoid, waves);
  WaveError error;
  std::vector<double> off_px;
  for (int y = 0; y < picture.size.height_px; ++y) {
    for (int x = 0; x < picture.size.width_px; ++x) {
      const auto offset = judge.offset_px(picture.at(x, y), {x + 0.5, y + 0.5});
      if (!offset) continue;
      off_px.push_back(glm::length(*offset));
      error.mean_px += *offset;
    }
  }
  if (off_px.empty()) return error;
  std::sort(off_px.begin(), off_px.end());
  error.pixels = static_cast<int>(off_px.size());
  error.most_px = off_px.back();
  error.usual_px = off_px[off_px.size() * 98 / 100];
  error.mean_px /= error.pixels;
  return error;
}

}  // namespace terrella::test
