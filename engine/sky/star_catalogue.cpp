#include "sky/star_catalogue.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <optional>
#include <string>

#include "base/number.h"
#include "geo/angle.h"

namespace terrella {
namespace {

constexpr std::size_t kMostStars = 200000;
constexpr double kWhite_bv = 0.4;

struct StarColumn {
  std::string_view name;
  double low, high;
};
constexpr std::array<StarColumn, 4> kStarColumns = {
    {{"ra_deg", -360.0, 360.0}, {"dec_deg", -90.0, 90.0}, {"vmag", -30.0, 30.0}, {"bv", -2.0, 10.0}}};
enum { ra, dec, vmag, bv_index };

using StarPlaces = std::array<std::size_t, kStarColumns.size()>;  ///< index of each column in a line

std::string_view next_line(std::string_view& rest) {
  const std::size_t end = rest.find('\n');
  std::string_view line = rest.substr(0, end);
  rest = end == std::string_view::npos ? std::string_view() : rest.substr(end + 1);
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return line;
}

Result<StarPlaces> read_heading(std::string_view line) {
  const std::vector<std::string_view> names = split_at_commas(line);
  StarPlaces places{};
  for (std::size_t k = 0; k < kStarColumns.size(); ++k) {
    const auto found = std::ranges::find(names, kStarColumns[k].name);
    if (found == names.end()) {
      return Error{"line 1, " + in_quotes(line) + ", is no heading of stars: it lacks the column " +
                   std::string(kStarColumns[k].name)};
    }
    places[k] = static_cast<std::size_t>(found - names.begin());
  }
  return places;
}

Result<Star> read_star(std::string_view line, const StarPlaces& places) {
  const std::vector<std::string_view> fields = split_at_commas(line);
  std::array<double, kStarColumns.size()> value{};
  for (std::size_t k = 0; k < kStarColumns.size(); ++k) {
    const StarColumn& column = kStarColumns[k];
    if (places[k] >= fields.size()) return Error{"it ends before the column " + std::string(column.name)};
    const std::string_view field = fields[places[k]];
    const auto number = k == bv_index && field.empty() ? std::optional(kWhite_bv) : read_number(field);
    if (!number || *number < column.low || *number > column.high) {
      return Error{std::string(column.name) + " is " + in_quotes(field) + ", but must be a number from " +
                   std::to_string(static_cast<int>(column.low)) + " to " +
                   std::to_string(static_cast<int>(column.high))};
    }
    value[k] = *number;
  }
  const double lon = Angle::degrees(value[ra]).rad(), lat = Angle::degrees(value[dec]).rad();
  const glm::dvec3 direction(std::cos(lat) * std::cos(lon), std::cos(lat) * std::sin(lon), std::sin(lat));
  return Star{glm::vec3(direction), static_cast<float>(value[vmag]), star_color_linear(value[bv_index])};
}

}  // namespace

glm::vec3 star_color_linear(double bv) {
  const double index = std::clamp(bv, -0.4, 2.5);
  const double kelvin =
      std::clamp(4600.0 * (1.0 / (0.92 * index + 1.7) + 1.0 / (0.92 * index + 0.62)), 1667.0, 25000.0);
  const double i = 1000.0 / kelvin;
  const double x = kelvin < 4000.0 ? ((-0.2661239 * i - 0.2343589) * i + 0.8776956) * i + 0.179910
                                   : ((-3.0258469 * i + 2.1070379) * i + 0.2226347) * i + 0.240390;
  double y = ((3.0817580 * x - 5.87338670) * x + 3.75112997) * x - 0.37001483;
  if (kelvin < 2222.0) {
    y = ((-1.1063814 * x - 1.34811020) * x + 2.18555832) * x - 0.20219683;
  } else if (kelvin < 4000.0) {
    y = ((-0.9549476 * x - 1.37418593) * x + 2.09137015) * x - 0.16748867;
  }
  // IEC 61966-2-1, sRGB from CIE XYZ.
  const glm::dmat3 srgb_from_xyz({3.2406, -0.9689, 0.0557}, {-1.5372, 1.8758, -0.2040}, {-0.4986, 0.0415, 1.0570});
  const glm::dvec3 rgb = glm::max(srgb_from_xyz * glm::dvec3(x / y, 1.0, (1.0 - x - y) / y), 0.0);
  return glm::vec3(rgb / glm::dot(rgb, glm::dvec3(0.2126, 0.7152, 0.0722)));
}

Result<std::vector<Star>> parse_stars(std::string_view csv) {
  const Result<StarPlaces> places = read_heading(next_line(csv));
  if (!places) return places.error();
  std::vector<Star> stars;
  for (int number = 2; !csv.empty(); ++number) {
    const std::string_view line = next_line(csv);
    if (line.empty()) continue;
    const Result<Star> star = read_star(line, *places);
    if (!star) return Error{"line " + std::to_string(number) + ", " + in_quotes(line) + ": " + star.error().message};
    stars.push_back(*star);
    if (stars.size() > kMostStars) return Error{"more than " + std::to_string(kMostStars) + " stars"};
  }
  if (stars.empty()) return Error{"there is no star behind its heading"};
  return stars;
}

}  // namespace terrella
