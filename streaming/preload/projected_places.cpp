#include "streaming/preload/projected_places.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "streaming/raster/tile_raster.h"

namespace terrella {
namespace {

/// Cells of tiles along a side. Each has nine points: its corners, the middles of its sides, and its middle.
constexpr int kCells = 4;
constexpr int kPoints = 2 * kCells + 1;
/// Part of a rectangle's side by which its tile may bulge out between the points.
constexpr double kBulge = 0.1;

/// An area of a coordinate system.
struct CrsArea {
  double west, south, east, north;
};

std::vector<CrsPoint> lattice_over(const CrsArea& area) {
  std::vector<CrsPoint> points;
  points.reserve(std::size_t{kPoints} * kPoints);
  for (int row = 0; row < kPoints; ++row) {
    for (int column = 0; column < kPoints; ++column) {
      points.push_back({std::lerp(area.west, area.east, double(column) / (kPoints - 1)),
                        std::lerp(area.north, area.south, double(row) / (kPoints - 1))});
    }
  }
  return points;
}

/// Cells [first, last] along both sides of an area, and its poles.
struct Cells {
  int first_column, last_column, first_row, last_row;
  bool has_north_pole, has_south_pole;
};

/// The rectangle around some places, with longitudes about that of the first.
struct Around {
  double west = 1e9, east = -1e9, south = 90.0, north = -90.0;
  bool empty = true;
  bool torn = false;  ///< a point has no place

  void add(const CrsPoint& place) {
    if (!std::isfinite(place.x) || !std::isfinite(place.y)) {
      torn = true;
      return;
    }
    const double near = empty ? std::remainder(place.x, 360.0) : west;
    const double lon = near + std::remainder(place.x - near, 360.0);
    empty = false;
    west = std::min(west, lon);
    east = std::max(east, lon);
    south = std::min(south, place.y);
    north = std::max(north, place.y);
  }
};

Around around_cells(const std::vector<CrsPoint>& places, const Cells& cells) {
  Around around;
  for (int row = 2 * cells.first_row; row <= 2 * cells.last_row + 2; ++row) {
    const CrsPoint* line = places.data() + std::ptrdiff_t{kPoints} * row;
    for (int column = 2 * cells.first_column; column <= 2 * cells.last_column + 2; ++column) around.add(line[column]);
  }
  return around;
}

/// Adds the rectangle around some cells, in two parts if it goes over ±180°.
void add_rect(const std::vector<CrsPoint>& places, const Cells& cells, std::vector<MapRect>& rects) {
  constexpr double kWidest_deg = 150.0;  // between two places that are compared by the shorter way
  const Around around = around_cells(places, cells);
  if (around.empty) return;
  const double width = around.east - around.west, more_lat = kBulge * (around.north - around.south);
  const bool round = around.torn || cells.has_north_pole || cells.has_south_pole || width > kWidest_deg;
  const bool to_south = around.torn || cells.has_south_pole, to_north = around.torn || cells.has_north_pole;
  const MapRect rect{.west_deg = round ? -180.0 : around.west - kBulge * width,
                     .south_deg = to_south ? -90.0 : std::max(-90.0, around.south - more_lat),
                     .east_deg = round ? 180.0 : around.east + kBulge * width,
                     .north_deg = to_north ? 90.0 : std::min(90.0, around.north + more_lat)};
  constexpr std::array kOtherTurns_deg{-360.0, 0.0, 360.0};
  for (const double turn_deg : kOtherTurns_deg) {
    MapRect part = rect;
    part.west_deg = std::max(-180.0, rect.west_deg + turn_deg);
    part.east_deg = std::min(180.0, rect.east_deg + turn_deg);
    if (part.west_deg < part.east_deg && part.south_deg < part.north_deg) rects.push_back(part);
  }
}

bool holds_point(const CrsArea& area, const CrsPoint& point) {
  return point.x >= area.west && point.x <= area.east && point.y >= area.south && point.y <= area.north;
}

}  // namespace

ProjectedPlaces::ProjectedPlaces(TileSetInfo info, Crs crs, std::vector<CrsPoint> poles)
    : info_(std::move(info)), raster_(raster_info_of(info_)), crs_(std::move(crs)), poles_(std::move(poles)) {}

Result<std::shared_ptr<const ProjectedPlaces>> ProjectedPlaces::open(const TileSetInfo& info) {
  Result<Crs> crs = Crs::open(info.square->crs);
  if (!crs) return crs.error();
  // After this success places() cannot fail either: both need only the same way between the systems.
  Result<std::vector<CrsPoint>> poles = crs->points({{0.0, 90.0}, {0.0, -90.0}});
  if (!poles) return poles.error();
  const std::shared_ptr<const ProjectedPlaces> made(new ProjectedPlaces(info, *std::move(crs), *std::move(poles)));
  // PROJ opens systems that it cannot compute, such as those of an unknown method, and then finds no place at all.
  const TilePlaces all = made->places(info.grid.min_level);
  const TileSpan columns{all.columns.front().first, all.columns.back().last};
  if (made->rects(info.grid.min_level, columns, all.rows).empty()) {
    return Error{fmt::format("PROJ finds no place of its tiles in the system {}", made->crs_.facts().name)};
  }
  return made;
}

const RasterLevel& ProjectedPlaces::level_of(int level) const {
  return raster_.levels[static_cast<std::size_t>(level - info_.grid.min_level)];
}

TilePlaces ProjectedPlaces::places(int level) const {
  if (info_.square->levels.empty()) return tile_places(info_.grid, level);
  const CrsLevel& place = info_.square->levels[static_cast<std::size_t>(level)];
  return {.columns = {{0, place.columns - 1}}, .rows = {0, place.rows - 1}};
}

double ProjectedPlaces::span_deg(int level) const {
  const RasterLevel& at = level_of(level);
  const CrsFacts& facts = crs_.facts();
  const double span = at.to_crs.x_per_column * static_cast<double>(at.block_width_px);
  return facts.geographic ? span * facts.unit_deg : span * facts.unit_m / facts.a_m * 180.0 / M_PI;
}

std::vector<MapRect> ProjectedPlaces::rects(int level, const TileSpan& columns, const TileSpan& rows) const {
  const RasterLevel& at = level_of(level);
  const double across = at.to_crs.x_per_column * static_cast<double>(at.block_width_px);
  const double down = at.to_crs.y_per_row * static_cast<double>(at.block_height_px);
  const CrsArea area{.west = at.to_crs.x0 + static_cast<double>(columns.first) * across,
                     .south = at.to_crs.y0 + static_cast<double>(rows.last + 1) * down,
                     .east = at.to_crs.x0 + static_cast<double>(columns.last + 1) * across,
                     .north = at.to_crs.y0 + static_cast<double>(rows.first) * down};
  const std::lock_guard lock(mutex_);
  const std::vector<CrsPoint> places = *crs_.places(lattice_over(area));
  std::vector<MapRect> rects;
  const auto has_pole = [&](std::size_t pole, const CrsArea& part) { return holds_point(part, poles_[pole]); };
  const bool single = columns.first == columns.last && rows.first == rows.last;
  const int step = single ? 1 : kCells;
  for (int row = 0; row < kCells; row += step) {
    for (int column = 0; column < kCells; column += step) {
      const CrsArea part{.west = std::lerp(area.west, area.east, double(column) / kCells),
                         .south = std::lerp(area.north, area.south, double(row + step) / kCells),
                         .east = std::lerp(area.west, area.east, double(column + step) / kCells),
                         .north = std::lerp(area.north, area.south, double(row) / kCells)};
      add_rect(places, {column, column + step - 1, row, row + step - 1, has_pole(0, part), has_pole(1, part)}, rects);
    }
  }
  return rects;
}

}  // namespace terrella
