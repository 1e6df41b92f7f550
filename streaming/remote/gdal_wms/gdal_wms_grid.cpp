#include "streaming/remote/gdal_wms/gdal_wms_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "geo/body.h"
#include "streaming/georeference/crs.h"
#include "streaming/georeference/figure.h"
#include "streaming/remote/crs_names.h"
#include "streaming/remote/wmts/ogc_choices.h"
#include "streaming/sets/gpkg_schema.h"
#include "tiles/grid_ranges.h"
#include "tiles/tile_range.h"

namespace terrella {
namespace {

/// Largest distance of a tile from its place in a grid, in texels. It is invisible.
constexpr double kMostOff_px = 0.1;
constexpr int kWmsTilePx = 512;

/// The window in degrees of a grid's rows.
struct DegreeWindow {
  double west, north, per_unit;
  Projection projection;
};

bool is_turned(double a_deg, double b_deg, double most_deg) {
  return !(std::abs(std::remainder(a_deg - b_deg, 360.0)) <= most_deg);
}

/// Degrees of a system in which longitudes and latitudes are evenly spaced, found and checked with PROJ.
std::optional<DegreeWindow> even_degrees(const Crs& crs, const GdalWindow& at) {
  const double unit = crs.facts().geographic ? crs.facts().unit_deg : 180.0 / (M_PI * crs.facts().a_m);
  const double half_turn = 180.0 / unit;
  // The window may reach beyond the planet.
  const double west = at.west, east = std::min(at.east, at.west + 2.0 * half_turn);
  const double north = std::min(at.north, half_turn / 2.0), south = std::max(at.south, -half_turn / 2.0);
  if (!(south < north)) return std::nullopt;
  constexpr std::array kParts = {0.25, 0.4, 0.5, 0.75};
  std::vector<CrsPoint> points;
  for (const double part : kParts) {
    points.push_back({west + part * (east - west), north + (1.0 - part) * (south - north)});
  }
  const auto places = crs.places(points);
  if (!places) return std::nullopt;
  const auto& first = places->front();
  // The nearest pair gives the slope without a turn between.
  const double per_unit = std::remainder((*places)[1].x - first.x, 360.0) / (points[1].x - points[0].x);
  if (!std::isfinite(per_unit) || per_unit <= 0.0) return std::nullopt;
  const double most_deg = kMostOff_px * at.pixel() * per_unit;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double lon = first.x + (points[i].x - points[0].x) * per_unit;
    const double lat = first.y + (points[i].y - points[0].y) * per_unit;
    if (is_turned((*places)[i].x, lon, most_deg) || !(std::abs((*places)[i].y - lat) <= most_deg)) return std::nullopt;
  }
  return DegreeWindow{.west = first.x + (at.west - points[0].x) * per_unit,
                      .north = first.y + (at.north - points[0].y) * per_unit,
                      .per_unit = per_unit,
                      .projection = Projection::equirectangular};
}

std::optional<DegreeWindow> degrees_of(const GdalWmsDocument& said, const Crs& crs) {
  if (!is_web_mercator(said.crs)) return even_degrees(crs, said.window);
  const double per_unit = 1.0 / kMercatorDegree_m;
  return DegreeWindow{.west = said.window.west * per_unit,
                      .north = said.window.north * per_unit,
                      .per_unit = per_unit,
                      .projection = Projection::web_mercator};
}

/// Number of whole tiles; none if the number is off by more than a part of a pixel.
std::optional<std::int64_t> whole_tiles_in(double extent_deg, double span_deg, int tile_px) {
  const double tiles = extent_deg / span_deg;
  if (!(std::abs(tiles) < kMaxTilesASide)) return std::nullopt;
  const double whole = std::round(tiles);
  return std::abs(tiles - whole) * tile_px <= kMostOff_px ? std::optional(std::llround(whole)) : std::nullopt;
}

/// A span that divides a turn, apart from rounding of the corners.
double tidy_span(double span_deg, const GdalWindow& at) {
  const double exact = 360.0 / std::round(360.0 / span_deg);
  const double tiles = std::ceil(static_cast<double>(std::max(at.width_px, at.height_px)) / at.block_px);
  return std::abs(span_deg / exact - 1.0) * tiles * at.block_px <= kMostOff_px ? exact : span_deg;
}

double wrapped_deg(double lon_deg) { return std::remainder(lon_deg, 360.0); }

/// Bounds of the window on the planet.
GeoRect bounds_of(const DegreeWindow& window, const GdalWindow& at) {
  const double west = window.west;
  const double east = west + (at.east - at.west) * window.per_unit;
  const bool mercator = window.projection == Projection::web_mercator;
  const double top = mercator ? 180.0 : 90.0;
  const auto latitude = [&](double row) {
    row = std::clamp(row, -top, top);
    return Angle::degrees(mercator ? latitude_of_mercator_row_deg(row) : row);
  };
  GeoRect rect{.south = latitude(window.north - (at.north - at.south) * window.per_unit),
               .north = latitude(window.north)};
  if (east - west >= 360.0 - kMostOff_px * at.pixel() * window.per_unit) return rect;
  const double begin = wrapped_deg(west);
  const double end = wrapped_deg(east);
  rect.west = Angle::degrees(begin >= 180.0 ? -180.0 : begin);
  rect.east = Angle::degrees(end <= -180.0 ? 180.0 : end);
  return rect;
}

/// Level of our grid that is the finest level of the window.
int finest_level_of(double span_deg, int server_level, double most_root_deg, int overviews) {
  if (std::ldexp(span_deg, server_level) <= most_root_deg && server_level <= kMaxTileLevel) return server_level;
  return std::clamp(static_cast<int>(std::floor(std::log2(most_root_deg / span_deg))),
                    std::min(overviews, kMaxTileLevel), kMaxTileLevel);
}

void name_levels(const GdalWindow& at, GdalWmsGrid& placed) {
  const int last = placed.grid.max_level;
  placed.level_names.clear();
  for (int level = 0; level <= last; ++level) {
    placed.level_names.push_back(std::to_string(std::max(0, at.level - (last - level))));
  }
  if (last == at.level) placed.level_names.clear();  // the names equal the level numbers
}

/// Rows of the window's tiles, `steps` levels above the finest.
std::int64_t rows_of(const GdalWindow& at, int steps) {
  const double tiles = std::ldexp(static_cast<double>(at.height_px) / at.block_px, -steps);
  return std::max<std::int64_t>(1, std::llround(std::ceil(tiles - 1e-6)));
}

/// True if the window is whole tiles at a level, `steps` above the finest. Tiles at an edge may be cut otherwise.
bool is_whole(const GdalWindow& at, int steps) {
  const std::int64_t tile = std::int64_t{at.block_px} << steps;
  return at.width_px % tile == 0 && at.height_px % tile == 0;
}

std::optional<GdalWmsGrid> on_planet(const GdalWindow& at, const DegreeWindow& window) {
  const bool mercator = window.projection == Projection::web_mercator;
  GdalWmsGrid placed;
  TileGrid& grid = placed.grid;
  grid.projection = window.projection;
  grid.tile_px = at.block_px;
  grid.bounds = bounds_of(window, at);
  const double span = tidy_span(at.pixel() * window.per_unit * at.block_px, at);
  const double top = mercator ? 180.0 : 90.0;
  const int last = finest_level_of(span, at.level, mercator ? 360.0 : kMaxRootSpanDeg, at.overviews);
  grid.root_span_deg = std::ldexp(span, last);
  grid.max_level = last;
  grid.min_level = last + 1;
  placed.shifts.resize(static_cast<std::size_t>(last) + 1);
  for (int steps = 0; steps <= std::min(at.overviews, last) && steps < 40; ++steps) {
    const double level_span = std::ldexp(span, steps);
    const auto columns_0 = whole_tiles_in(window.west + 180.0, level_span, at.block_px);
    const auto rows_0 = whole_tiles_in(top - window.north, level_span, at.block_px);
    if (!columns_0 || !rows_0 || !is_whole(at, steps)) break;
    const auto turn = *columns_0 == 0 ? 0 : whole_tiles_in(360.0, level_span, at.block_px).value_or(0);
    if (turn != 0 && at.column_0 != 0) break;  // columns wrap at the window's own
    grid.min_level = last - steps;
    placed.shifts[static_cast<std::size_t>(grid.min_level)] = {.columns = (at.column_0 >> steps) - *columns_0,
                                                               .rows = (at.row_0 >> steps) - *rows_0,
                                                               .turn_columns = turn,
                                                               .south_rows = rows_of(at, steps)};
  }
  if (grid.min_level > last || count_places(grid, grid.min_level) > kMaxRootTiles) return std::nullopt;
  name_levels(at, placed);
  return check_grid(grid, "") ? std::optional(placed) : std::nullopt;
}

/// The square whose north-west corner is the window's, as large as a whole number of halvings.
Result<GdalWmsGrid> on_own_square(const GdalWmsDocument& said) {
  const GdalWindow& at = said.window;
  const auto side_px = static_cast<double>(std::max(at.width_px, at.height_px));
  const int halvings = std::max(0, static_cast<int>(std::ceil(std::log2(side_px / at.block_px) - 1e-9)));
  const double side = std::ldexp(at.pixel() * at.block_px, halvings);
  GdalWmsGrid placed;
  TileGrid& grid = placed.grid;
  grid.projection = Projection::projected;
  grid.root_span_deg = 360.0;
  grid.tile_px = at.block_px;
  grid.max_level = halvings;
  grid.min_level = std::max(0, halvings - at.overviews);
  placed.square = CrsSquare{.crs = said.crs, .west = at.west, .north = at.north, .unit_per_deg = side / 360.0};
  grid.bounds = {.west = Angle::degrees(-180.0),
                 .south = Angle::degrees(180.0 - 360.0 * (at.north - at.south) / side),
                 .east = Angle::degrees(-180.0 + 360.0 * (at.east - at.west) / side),
                 .north = Angle::degrees(180.0)};
  if (const auto roots = count_places(grid, grid.min_level); roots > kMaxRootTiles) {
    return Error{fmt::format("its coarsest level has {} tiles, at most {} can be root tiles; raise OverviewCount",
                             roots, kMaxRootTiles)};
  }
  for (int level = 0; level <= halvings; ++level) {
    const int steps = halvings - level;
    placed.shifts.push_back(
        {.columns = at.column_0 >> steps, .rows = at.row_0 >> steps, .south_rows = rows_of(at, steps)});
  }
  name_levels(at, placed);
  if (Status fine = check_grid(grid, "its window"); !fine) return fine.error();
  return placed;
}

/// The grid for requests of any rectangle: the finest level has pixels no larger than the window's.
GdalWmsGrid free_grid(const GdalWmsDocument& said, const std::optional<DegreeWindow>& window) {
  const GdalWindow& at = said.window;
  GdalWmsGrid placed;
  TileGrid& grid = placed.grid;
  grid.tile_px = at.block_px >= kMinTilePx && at.block_px < kWmsTilePx ? at.block_px : kWmsTilePx;
  double pixel_deg = 0.0;
  if (window) {
    grid.projection = window->projection;
    grid.root_span_deg = grid.projection == Projection::web_mercator ? 360.0 : 180.0;
    grid.bounds = bounds_of(*window, at);
    pixel_deg = at.pixel() * window->per_unit;
  } else {
    const double side = std::max(at.east - at.west, at.north - at.south);
    grid.projection = Projection::projected;
    grid.root_span_deg = 360.0;
    placed.square = CrsSquare{.crs = said.crs, .west = at.west, .north = at.north, .unit_per_deg = side / 360.0};
    grid.bounds = {.west = Angle::degrees(-180.0),
                   .south = Angle::degrees(180.0 - 360.0 * (at.north - at.south) / side),
                   .east = Angle::degrees(-180.0 + 360.0 * (at.east - at.west) / side),
                   .north = Angle::degrees(180.0)};
    pixel_deg = at.pixel() / placed.square->unit_per_deg;
  }
  const double halvings = std::ceil(std::log2(grid.root_span_deg / grid.tile_px / pixel_deg) - 1e-6);
  grid.max_level = static_cast<int>(std::clamp(halvings, 0.0, static_cast<double>(kMaxTileLevel)));
  return placed;
}

/// A window of whole degrees in a system of metres is a mistake that many files make.
std::optional<Error> mistaken_degrees(const GdalWmsDocument& said, const CrsFacts& facts) {
  const GdalWindow& at = said.window;
  const bool of_planet = at.west >= -180.0 && at.east <= 360.0 && at.east - at.west == 360.0 && at.north == 90.0;
  if (facts.geographic || !of_planet) return std::nullopt;
  return Error{
      fmt::format("its <DataWindow> is in degrees, and its <Projection> ({}) counts metres; write <Projection>"
                  "+proj=longlat +a={:.12g} +b={:.12g}</Projection>",
                  facts.name, facts.a_m, facts.b_m)};
}

}  // namespace

Result<GdalWmsGrid> place_gdal_window(const GdalWmsDocument& said) {
  const Result<Crs> crs = Crs::open(said.crs);
  if (!crs) return Error{"<Projection>: " + crs.error().message};
  if (auto mistake = mistaken_degrees(said, crs->facts())) return *std::move(mistake);
  const auto window = degrees_of(said, *crs);
  const bool is_wms = said.service == GdalWmsDocument::Service::wms;
  std::optional<GdalWmsGrid> placed;
  if (is_wms) {
    placed = free_grid(said, window);
  } else if (window) {
    placed = on_planet(said.window, *window);
  }
  if (!placed) {
    Result<GdalWmsGrid> own = on_own_square(said);
    if (!own) return own.error();
    placed = *std::move(own);
  }
  placed->body = body_name(crs->facts());
  const auto body = parse_body(placed->body);
  if (body && !placed->square) placed->grid.latitude = latitude_of(crs->facts(), *body);
  return *std::move(placed);
}

}  // namespace terrella
