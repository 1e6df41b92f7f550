#include "streaming/cut/mercator_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "tiles/grid_ranges.h"

namespace terrella {
namespace {

/// A pixel of which the picture covers less has no visible alpha.
constexpr double kSliver_px = 1.0 / 512.0;
/// Part of a pixel's size that counts as rounding.
constexpr double kRounding = 1e-9;

Result<int> finest_zoom(double pixel_deg, int tile_px, const std::string& name) {
  for (int zoom = 0; zoom <= kMaxTileLevel; ++zoom) {
    if (std::ldexp(360.0 / tile_px, -zoom) <= pixel_deg * (1.0 + kRounding)) return zoom;
  }
  return Error{
      fmt::format("{}: pixels of {:.3g} degrees need a zoom over {}; make the picture smaller, or leave ‹grid› out",
                  name, pixel_deg, kMaxTileLevel)};
}

/// First and last edge of the picture along one direction, in pixels of the plan.
struct Span {
  std::int64_t begin, end;
};
Span whole_pixels(double from, double to, bool halves) {
  if (halves) return {std::llround(from), std::llround(to)};
  return {static_cast<std::int64_t>(std::floor(from + kSliver_px)),
          static_cast<std::int64_t>(std::ceil(to - kSliver_px))};
}

/// Latitude of an edge between the picture's rows.
Angle edge_latitude(const CutPlan& picture, const Ellipsoid& figure, std::int64_t row) {
  const double row_deg = picture.grid.north_deg - static_cast<double>(row) * picture.pixel_deg;
  return latitude_of_row(picture.grid, figure, row_deg);
}

GeoRect covered_square(const CutPlan& plan) {
  const double west = mercator_lon_deg(plan, static_cast<double>(plan.finest.x0));
  const double east = mercator_lon_deg(plan, static_cast<double>(plan.finest.x1 - plan.turn_px));
  return {.west = Angle::degrees(plan.wraps ? -180.0 : west),
          .south = mercator_latitude(plan, static_cast<double>(plan.finest.y1)),
          .east = Angle::degrees(plan.wraps ? 180.0 : std::min(east, 180.0)),
          .north = mercator_latitude(plan, static_cast<double>(plan.finest.y0))};
}

}  // namespace

double picture_column(const CutPlan& picture, double lon_deg) {
  return (lon_deg - picture.grid.west_deg) / picture.pixel_deg - static_cast<double>(picture.finest.x0);
}

double picture_row(const CutPlan& picture, const Ellipsoid& figure, Angle latitude) {
  const double row_deg = row_latitude_deg(picture.grid, figure, Ellipsoid::normal(latitude, Angle{}));
  return (picture.grid.north_deg - row_deg) / picture.pixel_deg - static_cast<double>(picture.finest.y0);
}

double mercator_lon_deg(const CutPlan& plan, double column) { return column * plan.pixel_deg - 180.0; }

Angle mercator_latitude(const CutPlan& plan, double row) {
  return Angle::degrees(latitude_of_mercator_row_deg(180.0 - row * plan.pixel_deg));
}

bool reaches_beyond_mercator(const CutPlan& picture, const Ellipsoid& figure) {
  const Angle end = Angle::degrees(kMercatorEndDeg + picture.pixel_deg);  // bounds are rounded outwards to pixels
  return edge_latitude(picture, figure, picture.finest.y0) > end ||
         edge_latitude(picture, figure, picture.finest.y1) < -end;
}

Result<CutPlan> mercator_plan(const CutPlan& picture, const Ellipsoid& figure, bool halves, const std::string& name) {
  const int tile_px = picture.grid.tile_px;
  const auto finest = finest_zoom(picture.pixel_deg, tile_px, name);
  if (!finest) return finest.error();
  const bool crosses = picture.turn_px > 0;
  const int zoom = crosses ? std::max(*finest, 1) : *finest;
  CutPlan plan;
  plan.wraps = picture.wraps;
  plan.pixel_deg = std::ldexp(360.0 / tile_px, -zoom);
  plan.grid.root_span_deg = crosses ? 180.0 : 360.0;
  plan.grid.tile_px = tile_px;
  plan.grid.max_level = crosses ? zoom - 1 : zoom;
  plan.grid.projection = Projection::web_mercator;
  const std::int64_t turn = std::int64_t{tile_px} << zoom;
  if (crosses) plan.turn_px = turn;

  const auto column = [&](std::int64_t x) {
    return (picture.grid.west_deg + static_cast<double>(x) * picture.pixel_deg + 180.0) / plan.pixel_deg;
  };
  const auto row = [&](std::int64_t y) {
    return (180.0 - mercator_row_deg(edge_latitude(picture, figure, y).deg())) / plan.pixel_deg;
  };
  Span columns = whole_pixels(column(picture.finest.x0), column(picture.finest.x1), halves);
  if (!crosses) columns.end = std::min(columns.end, turn);
  if (plan.wraps) columns = {0, turn};
  const Span rows = whole_pixels(row(picture.finest.y0), row(picture.finest.y1), halves);
  if (rows.begin >= rows.end || columns.begin >= columns.end) {
    return Error{
        fmt::format("{}: no pixel of it lies between the latitudes {:.4f} and {:.4f} of Web Mercator; leave "
                    "‹grid› out and name an output that ends in .gpkg, or a folder",
                    name, -kMercatorEndDeg, kMercatorEndDeg)};
  }
  plan.finest = {.x0 = columns.begin, .y0 = rows.begin, .x1 = columns.end, .y1 = rows.end};
  plan.picture_rows = rows.end - rows.begin;
  plan.grid.bounds = covered_square(plan);
  if (Status good = check_grid(plan.grid, name); !good) return good.error();
  return plan;
}

}  // namespace terrella
