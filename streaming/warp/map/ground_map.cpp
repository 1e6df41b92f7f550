#include "streaming/warp/map/ground_map.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

namespace terrella {
namespace {

constexpr double kNowhere = std::numeric_limits<double>::infinity();
constexpr double kToRad = std::numbers::pi / 180.0;

CrsPoint minus(CrsPoint a, CrsPoint b) { return {a.x - b.x, a.y - b.y}; }
bool is_placed(CrsPoint point) { return std::isfinite(point.x) && std::isfinite(point.y); }

/// Pixel coordinates of a vector in the coordinate system.
CrsPoint pixels_of(const Affine& to_crs, CrsPoint vector) {
  const double det = to_crs.x_per_column * to_crs.y_per_row - to_crs.x_per_row * to_crs.y_per_column;
  return {(to_crs.y_per_row * vector.x - to_crs.x_per_row * vector.y) / det,
          (to_crs.x_per_column * vector.y - to_crs.y_per_column * vector.x) / det};
}

/// tan(to) / tan(from), for two kinds of latitude.
double tangent_ratio(const Ellipsoid& ellipsoid, LatitudeKind from, LatitudeKind to) {
  if (from == to) return 1.0;
  return to == LatitudeKind::centric ? ellipsoid.one_minus_e2() : 1.0 / ellipsoid.one_minus_e2();
}

double with_tangent(double latitude_deg, double ratio) {
  if (ratio == 1.0 || !(std::abs(latitude_deg) < 90.0)) return latitude_deg;
  return std::atan2(ratio * std::sin(latitude_deg * kToRad), std::cos(latitude_deg * kToRad)) / kToRad;
}

LatitudeKind latitude_of(const Crs& crs, const WarpFigure& figure) {
  if (figure.crs_latitude) return *figure.crs_latitude;
  const bool is_sphere = crs.facts().b_m == crs.facts().a_m;
  const bool flattened = figure.ellipsoid.f() > 0.0;
  const bool centric = crs.facts().centric || (is_sphere && flattened && !crs.is_earth());
  return centric ? LatitudeKind::centric : LatitudeKind::graphic;
}

// Samples of the test for a turn.
constexpr int kSteps = 36;
constexpr double kStep_deg = 360.0 / kSteps;
/// Largest difference between equal steps, relative to a turn: PROJ's rounding.
constexpr double kSameStep = 1e-10;

/// Differences between points of the map 10° apart on a parallel. Empty if a point has no place on the map.
std::vector<CrsPoint> steps_along(const Crs& crs, double latitude_deg) {
  std::vector<CrsPoint> places;
  for (int i = 0; i <= kSteps; ++i) places.push_back({-179.0 + i * kStep_deg, latitude_deg});
  const auto points = crs.points(std::move(places));
  std::vector<CrsPoint> steps;
  if (!points || !std::ranges::all_of(*points, is_placed)) return steps;
  for (std::size_t i = 1; i < points->size(); ++i) steps.push_back(minus((*points)[i], (*points)[i - 1]));
  return steps;
}

}  // namespace

Affine level_from_finest(const RasterLevel& level, const RasterLevel& finest) {
  const auto turned = [&](CrsPoint vector) { return pixels_of(level.to_crs, vector); };
  const CrsPoint origin = turned(minus(finest.to_crs.at(0.0, 0.0), level.to_crs.at(0.0, 0.0)));
  const CrsPoint column = turned({finest.to_crs.x_per_column, finest.to_crs.y_per_column});
  const CrsPoint row = turned({finest.to_crs.x_per_row, finest.to_crs.y_per_row});
  return {origin.x, column.x, row.x, origin.y, column.y, row.y};
}

GroundMap::GroundMap(Crs crs, const Affine& to_crs, const WarpFigure& figure)
    : crs_(std::move(crs)),
      to_crs_(to_crs),
      to_crs_tangent_(tangent_ratio(figure.ellipsoid, figure.latitude, latitude_of(crs_, figure))) {}

Result<GroundMap> GroundMap::open(const RasterInfo& raster, const WarpFigure& figure) {
  auto crs = Crs::open(raster.crs);
  if (!crs) return crs.error();
  if (const auto path = crs->points({}); !path) return path.error();
  GroundMap map(*std::move(crs), raster.levels.back().to_crs, figure);
  map.find_turn();
  return map;
}

/// A cylindrical map has equal steps on all parallels. One step may jump by a turn, at the end of the map.
void GroundMap::find_turn() {
  std::optional<CrsPoint> step;
  std::size_t end = 0;
  for (const double latitude : {0.5, -20.0, 37.0, -55.0, 70.0}) {
    const std::vector<CrsPoint> steps = steps_along(crs_, latitude);
    if (steps.empty()) return;
    if (!step)
      step = std::abs(steps[0].x - steps[1].x) + std::abs(steps[0].y - steps[1].y) <
                     std::abs(steps[1].x - steps[2].x) + std::abs(steps[1].y - steps[2].y)
                 ? steps[0]
                 : steps[2];
    const double turn = kSteps * std::hypot(step->x, step->y);
    int jumps = 0;
    for (std::size_t i = 0; i < steps.size(); ++i) {
      const CrsPoint off = minus(steps[i], *step);
      if (std::hypot(off.x, off.y) <= kSameStep * turn) continue;
      if (++jumps > 1 || std::hypot(off.x + kSteps * step->x, off.y + kSteps * step->y) > 1e-6 * turn) return;
      end = i;
    }
  }
  middle_lon_deg_ = -179.0 + (static_cast<double>(end) + 0.5) * kStep_deg + 180.0;
  const auto wide = crs_.points({{middle_lon_deg_ - 120.0, 0.5}, {middle_lon_deg_ + 120.0, 0.5}});
  if (!wide || !is_placed((*wide)[0]) || !is_placed((*wide)[1])) return;
  const CrsPoint apart = minus((*wide)[1], (*wide)[0]);
  turn_px_ = pixels_of(to_crs_, {apart.x * 1.5, apart.y * 1.5});
}

double GroundMap::crs_latitude_deg(double row_deg) const { return with_tangent(row_deg, to_crs_tangent_); }

CrsPoint GroundMap::pixel_of(CrsPoint point) const {
  if (!is_placed(point)) return {kNowhere, kNowhere};
  return pixels_of(to_crs_, {point.x - to_crs_.x0, point.y - to_crs_.y0});
}

void GroundMap::pixels(std::span<const RowPlace> places, std::span<CrsPoint> out) const {
  std::vector<CrsPoint> points(places.size());
  std::ranges::transform(places, points.begin(), [this](const RowPlace& place) {
    return CrsPoint{turn_px_ ? middle_lon_deg_ : place.lon_deg, crs_latitude_deg(place.row_deg)};
  });
  const auto found = crs_.points(std::move(points));
  for (std::size_t i = 0; i < out.size(); ++i) {
    const bool on_planet = found && std::abs(places[i].row_deg) <= 90.0;
    out[i] = on_planet ? pixel_of((*found)[i]) : CrsPoint{kNowhere, kNowhere};
    if (!turn_px_) continue;
    const double turns = (places[i].lon_deg - middle_lon_deg_) / 360.0;
    out[i].x += turns * turn_px_->x;
    out[i].y += turns * turn_px_->y;
  }
}

std::vector<RowPlace> GroundMap::places(std::span<const CrsPoint> pixels) const {
  std::vector<CrsPoint> points;
  for (const CrsPoint& pixel : pixels) points.push_back(to_crs_.at(pixel.x, pixel.y));
  const auto found = crs_.places(std::move(points));
  std::vector<RowPlace> places(pixels.size(), {kNowhere, kNowhere});
  if (!found) return places;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const CrsPoint& place = (*found)[i];
    if (is_placed(place) && std::abs(place.y) <= 90.0 + 1e-9) {
      places[i] = {place.x, with_tangent(std::clamp(place.y, -90.0, 90.0), 1.0 / to_crs_tangent_)};
    }
  }
  return places;
}

GroundMaps::GroundMaps(RasterInfo raster, const WarpFigure& figure, GroundMap map)
    : raster_(std::move(raster)), figure_(figure), turn_px_(map.turn_px()) {
  idle_.push_back(std::move(map));
}

Result<std::shared_ptr<GroundMaps>> GroundMaps::open(const RasterInfo& raster, const WarpFigure& figure) {
  auto map = GroundMap::open(raster, figure);
  if (!map) return map.error();
  return std::shared_ptr<GroundMaps>(new GroundMaps(raster, figure, *std::move(map)));
}

Result<GroundMap, TileFailure> GroundMaps::take() {
  {
    const std::lock_guard lock(mutex_);
    if (!idle_.empty()) {
      GroundMap map = std::move(idle_.back());
      idle_.pop_back();
      return map;
    }
  }
  auto opened = GroundMap::open(raster_, figure_);
  if (!opened) return TileFailure{MissingKind::failed, opened.error().message};
  return *std::move(opened);
}

void GroundMaps::put_back(GroundMap map) {
  const std::lock_guard lock(mutex_);
  idle_.push_back(std::move(map));
}

}  // namespace terrella
