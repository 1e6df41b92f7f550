#include "streaming/remote/wmts/wmts_axes.h"

#include <cmath>
#include <cstddef>
#include <vector>

#include "streaming/georeference/crs_text.h"
#include "streaming/remote/wmts/ogc_choices.h"

namespace terrella {
namespace {

/// Parts of a tile by which a corner and its box may differ.
constexpr double kBoxSlack = 0.01;

/// Order of a set's axes by its own BoundingBox: the corner has the least easting and the greatest northing.
std::optional<bool> order_of_box(const WmtsMatrixSet& set, double tile_span) {
  if (!set.box) return std::nullopt;
  const auto [first, second] = set.matrices.back().corner;
  const auto near = [&](double a, double b) { return std::abs(a - b) <= kBoxSlack * tile_span; };
  const bool easting = near(first, set.box->low.first) && near(second, set.box->high.second);
  const bool northing = near(first, set.box->high.first) && near(second, set.box->low.second);
  return easting == northing ? std::nullopt : std::optional(northing);
}

/// Order of degrees: a number beyond ±90° is a longitude.
std::optional<bool> order_of_degrees(const WmtsMatrix& matrix, const CrsFacts& facts) {
  const auto is_longitude = [&](double number) { return std::abs(number) * facts.unit_deg > 90.0 + 1e-6; };
  const bool first = is_longitude(matrix.corner.first), second = is_longitude(matrix.corner.second);
  return !facts.geographic || first == second ? std::nullopt : std::optional(second);
}

/// Places all over an area, which may cross ±180°.
std::vector<CrsPoint> lattice(const GeoRect& area) {
  constexpr int kSide = 11;
  const double west = area.west.deg(), east = area.east.deg() + (area.east < area.west ? 360.0 : 0.0);
  std::vector<CrsPoint> places;
  places.reserve(std::size_t{kSide} * kSide);
  for (int row = 0; row < kSide; ++row) {
    for (int column = 0; column < kSide; ++column) {
      const double across = (column + 0.5) / kSide, up = (row + 0.5) / kSide;
      places.push_back({std::lerp(west, east, across), std::lerp(area.south.deg(), area.north.deg(), up)});
    }
  }
  return places;
}

/// Number of points in the area of a matrix that begins at (west, north).
std::size_t count_inside(const std::vector<CrsPoint>& points, const WmtsMatrix& matrix, CrsPoint corner, double span) {
  const double east = corner.x + static_cast<double>(matrix.columns) * span;
  const double south = corner.y - static_cast<double>(matrix.rows) * span;
  std::size_t inside = 0;
  for (const CrsPoint& point : points) {
    if (point.x >= corner.x && point.x <= east && point.y >= south && point.y <= corner.y) ++inside;
  }
  return inside;
}

}  // namespace

bool has_northing_first(const WmtsMatrixSet& set, const WmtsSystem& system, const std::optional<GeoRect>& bounds) {
  const WmtsMatrix& finest = set.matrices.back();
  const double span = finest.scale_denominator * kOgcPixel_m / system.unit_m * finest.tile_px;
  if (const auto order = order_of_box(set, span)) return *order;
  if (const auto order = order_of_degrees(finest, system.crs.facts())) return *order;
  const Result<bool> known = is_northing_first(system.text);
  const bool defined = known && *known;
  const auto points = bounds ? system.crs.points(lattice(*bounds)) : Result<std::vector<CrsPoint>>(Error{});
  if (!points) return defined;
  const auto [first, second] = finest.corner;
  const std::size_t easting = count_inside(*points, finest, {first, second}, span);
  const std::size_t northing = count_inside(*points, finest, {second, first}, span);
  // Layers may claim the whole planet, so a few places more in one order prove nothing.
  if (easting > 2 * northing) return false;
  if (northing > 2 * easting) return true;
  return defined;
}

}  // namespace terrella
