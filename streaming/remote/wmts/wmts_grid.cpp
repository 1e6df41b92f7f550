#include "streaming/remote/wmts/wmts_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geo/body.h"
#include "streaming/remote/crs_names.h"
#include "streaming/remote/wmts/ogc_choices.h"
#include "streaming/remote/wmts/wmts_projected.h"
#include "tiles/grid_ranges.h"
#include "tiles/tile_range.h"

namespace terrella {
namespace {

constexpr double kEarthRadius_m = 6378137.0;
/// Tolerance of scale denominators. They usually have a dozen digits; ten digits still place a tile of level 24 well.
constexpr double kRelativeSlack = 1e-6;
/// Servers use different lists of radii. Those for Mars differ by 6e-5.
constexpr double kRadiusSlack = 1e-3;
/// Largest distance of a tile from its place in the grid, in texels. It is invisible.
constexpr double kSlackTexels = 0.1;

double span_deg(const WmtsMatrix& matrix, double radius_m) {
  const double degree_m = radius_m * std::numbers::pi / 180.0;
  return matrix.scale_denominator * kOgcPixel_m / degree_m * matrix.tile_px;
}

/// True if whole tiles cover an extent and no tile begins beyond it.
bool covers(std::int64_t tiles, double span, double extent_deg, double slack) {
  const auto count = static_cast<double>(tiles);
  return count * span >= extent_deg * (1.0 - slack) && (count - 1.0) * span < extent_deg * (1.0 + slack);
}

bool covers_planet(const WmtsMatrix& matrix, double span, double slack) {
  return covers(matrix.columns, span, 360.0, slack) && covers(matrix.rows, span, 180.0, slack);
}

/// Span of a tile of the finest matrix.
double finest_span_deg(const WmtsMatrix& finest, const std::string& body) {
  const auto whole_turn = [&](double span, double slack) {
    const double exact = 360.0 / static_cast<double>(finest.columns);
    return std::abs(span / exact - 1.0) < slack ? exact : span;
  };
  const double span = span_deg(finest, kEarthRadius_m);
  const auto figure = parse_body(body);
  if (covers_planet(finest, span, kRelativeSlack) || !figure) return whole_turn(span, kRelativeSlack);
  const double own = span_deg(finest, figure->ellipsoid.a_m());
  return covers_planet(finest, own, kRadiusSlack) ? whole_turn(own, kRadiusSlack) : whole_turn(span, kRelativeSlack);
}

std::optional<std::string> fault_among(const std::vector<WmtsMatrix>& matrices) {
  for (std::size_t i = 1; i < matrices.size(); ++i) {
    const WmtsMatrix& coarse = matrices[i - 1];
    const WmtsMatrix& fine = matrices[i];
    if (coarse.tile_px != fine.tile_px) return "its matrices have tiles of different sizes in pixels";
    if (coarse.corner != fine.corner) {
      return fmt::format("its corners move: \"{}\" begins at ({}, {}), \"{}\" at ({}, {})", coarse.name,
                         coarse.corner.first, coarse.corner.second, fine.name, fine.corner.first, fine.corner.second);
    }
    const double ratio = coarse.scale_denominator / fine.scale_denominator;
    if (std::abs(ratio - 2.0) > 2.0 * kRelativeSlack) {
      return fmt::format("its levels do not halve: from \"{}\" to \"{}\" it is a factor of {:.6g}", coarse.name,
                         fine.name, ratio);
    }
  }
  return std::nullopt;
}

struct Corner {
  double lon, lat;
};

/// Corner in degrees. The number of 90° or more must be the latitude of a planet's top left corner, whatever the order.
Corner corner_of(const WmtsMatrix& matrix, bool latitude_first) {
  const auto [a, b] = matrix.corner;
  constexpr double kTop = 90.0 - 1e-6;
  const bool first = latitude_first ? (a >= kTop || b < kTop) : (b < kTop && a >= kTop);
  return first ? Corner{.lon = b, .lat = a} : Corner{.lon = a, .lat = b};
}

/// Corner of a matrix in EPSG:3857, in degrees of the grid's rows. The system counts metres on a sphere with the
/// Earth's equator, eastings first.
Corner mercator_corner_of(const WmtsMatrix& matrix) {
  const double degree_m = kEarthRadius_m * std::numbers::pi / 180.0;
  // Some servers write the corner of the square with two decimals, some with none.
  constexpr double kRounding_m = 0.6;
  const auto degrees = [&](double metres, double end_deg) {
    return std::abs(metres - end_deg * degree_m) <= kRounding_m ? end_deg : metres / degree_m;
  };
  return {.lon = degrees(matrix.corner.first, -180.0), .lat = degrees(matrix.corner.second, 180.0)};
}

bool begins_at_square(const Corner& corner) { return corner.lon == -180.0 && corner.lat == 180.0; }

/// Span of a tile. The number of tiles round the planet is a power of two, apart from rounding of the scale.
double mercator_span_deg(const WmtsMatrix& matrix) {
  const double span = span_deg(matrix, kEarthRadius_m);
  const double exact = std::ldexp(360.0, -static_cast<int>(std::lround(std::log2(360.0 / span))));
  return std::abs(span / exact - 1.0) < kRelativeSlack ? exact : span;
}

std::optional<std::int64_t> whole_tiles(double offset_deg, double span, int tile_px) {
  const double tiles = offset_deg / span;
  if (!(std::abs(tiles) < kMaxTilesASide)) return std::nullopt;
  const double whole = std::round(tiles);
  return std::abs(tiles - whole) * tile_px <= kSlackTexels ? std::optional(std::llround(whole)) : std::nullopt;
}

std::optional<TileShift> shift_of(const Corner& corner, double top_deg, double span, int tile_px) {
  const auto columns = whole_tiles(corner.lon + 180.0, span, tile_px);
  const auto rows = whole_tiles(top_deg - corner.lat, span, tile_px);
  if (!columns || !rows) return std::nullopt;
  const std::int64_t turn = *columns == 0 ? 0 : whole_tiles(360.0, span, tile_px).value_or(0);
  return TileShift{.columns = -*columns, .rows = -*rows, .turn_columns = turn};
}

/// Area of a matrix's tiles in degrees. Longitudes begin at -180° and are not wrapped.
struct Extent {
  double west, south, east, north;
};

Extent extent_of(const Corner& corner, double span, const WmtsLimits& tiles) {
  return {.west = corner.lon + static_cast<double>(tiles.first_column) * span,
          .south = corner.lat - static_cast<double>(tiles.last_row + 1) * span,
          .east = corner.lon + static_cast<double>(tiles.last_column + 1) * span,
          .north = corner.lat - static_cast<double>(tiles.first_row) * span};
}

WmtsLimits all_of(const WmtsMatrix& matrix) {
  return {.matrix = matrix.name, .last_column = matrix.columns - 1, .last_row = matrix.rows - 1};
}

WmtsLimits within(const WmtsLimits& limits, const WmtsMatrix& matrix) {
  const WmtsLimits all = all_of(matrix);
  return {.matrix = matrix.name,
          .first_column = std::min(limits.first_column, all.last_column),
          .last_column = std::min(limits.last_column, all.last_column),
          .first_row = std::min(limits.first_row, all.last_row),
          .last_row = std::min(limits.last_row, all.last_row)};
}

double wrapped(double lon_deg) { return std::remainder(lon_deg, 360.0); }

GeoRect rect_of(const Extent& extent, Projection projection) {
  const auto latitude = [&](double row_deg) {
    const bool mercator = projection == Projection::web_mercator;
    return Angle::degrees(mercator ? latitude_of_mercator_row_deg(row_deg) : std::clamp(row_deg, -90.0, 90.0));
  };
  GeoRect rect{.south = latitude(extent.south), .north = latitude(extent.north)};
  if (extent.east - extent.west >= 360.0 * (1.0 - kRelativeSlack)) return rect;
  const bool plain = extent.west >= -180.0 && extent.west < 180.0;
  rect.west = Angle::degrees(plain ? extent.west : wrapped(extent.west));
  // An extent from -180° that reaches beyond 180° is padded.
  const bool padded = extent.west >= -180.0 && extent.east > 180.0 && extent.west < 0.0;
  rect.east = Angle::degrees(padded ? 180.0 : wrapped(extent.east));
  if (rect.east.deg() <= -180.0) rect.east = Angle::degrees(180.0);
  return rect;
}

/// A matrix set that is being placed on a grid.
struct Placing {
  const WmtsMatrixSet& set;
  Corner corner;  ///< in the grid's rows
  double top_deg;
  double root_span;  ///< span of the coarsest matrix
  [[nodiscard]] double span(std::size_t i) const { return std::ldexp(root_span, -static_cast<int>(i)); }
  [[nodiscard]] std::optional<TileShift> shift(std::size_t i) const {
    return shift_of(corner, top_deg, span(i), set.matrices[i].tile_px);
  }
};

/// Chooses the matrices that become levels. They must lie on whole tiles and be listed in the limits, if there are any.
/// Without limits they must have all the tiles of the finest matrix.
Status choose_levels(const Placing& placing, const std::vector<WmtsLimits>& limits, TileGrid& grid) {
  const std::vector<WmtsMatrix>& matrices = placing.set.matrices;
  const auto usable = [&](std::size_t i) { return limits.empty() || limits_of(limits, matrices[i].name) != nullptr; };
  std::size_t last = std::min<std::size_t>(matrices.size(), kMaxTileLevel + 1);
  while (last > 0 && !usable(last - 1)) --last;
  if (last == 0) return Error{"none of its matrices is in the layer's TileMatrixSetLimits"};
  const std::size_t finest = last - 1;
  if (!placing.shift(finest)) {
    return Error{fmt::format("its tiles begin at ({}°, {}°), which is no whole number of tiles ({}°) from (-180°, {}°)",
                             placing.corner.lon, placing.corner.lat, placing.span(finest), placing.top_deg)};
  }
  const WmtsLimits* said = limits_of(limits, matrices[finest].name);
  const Extent data = extent_of(placing.corner, placing.span(finest),
                                said != nullptr ? within(*said, matrices[finest]) : all_of(matrices[finest]));
  const double slack = kSlackTexels * placing.span(finest) / matrices[finest].tile_px;
  std::size_t first = finest;
  while (first > 0 && usable(first - 1) && placing.shift(first - 1)) {
    const Extent coarser = extent_of(placing.corner, placing.span(first - 1), all_of(matrices[first - 1]));
    const double east = std::min(data.east, placing.corner.lon + 360.0);
    const double south = std::max(data.south, -placing.top_deg);
    if (coarser.east < east - slack || coarser.south > south + slack) break;
    --first;
  }
  grid.min_level = static_cast<int>(first);
  grid.max_level = static_cast<int>(finest);
  grid.bounds = rect_of(data, grid.projection);
  if (!(grid.bounds.south < grid.bounds.north)) return Error{"none of its tiles lies on the planet"};
  return Done{};
}

void name_levels(const Placing& placing, WmtsGrid& placed) {
  bool moved = false;
  for (std::size_t i = 0; i <= static_cast<std::size_t>(placed.grid.max_level); ++i) {
    placed.level_names.push_back(placing.set.matrices[i].name);
    placed.shifts.push_back(placing.shift(i).value_or(TileShift{}));
    moved = moved || placed.shifts.back().columns != 0 || placed.shifts.back().rows != 0;
  }
  if (!moved) placed.shifts.clear();
}

}  // namespace

Result<WmtsGrid> grid_of(const WmtsMatrixSet& set, const std::vector<WmtsLimits>& limits,
                         const std::optional<std::string>& body, const std::optional<GeoRect>& bounds) {
  const bool mercator = is_web_mercator(set.crs);
  const Result<GeographicCrs> crs = mercator ? GeographicCrs{.body = "earth"} : parse_crs(set.crs);
  if (!crs) return projected_grid_of(set, limits, bounds);
  if (const auto fault = fault_among(set.matrices)) {
    // Servers count the degrees of other bodies in two ways, of which only whole planets tell.
    if (crs->body != "earth" || body) return Error{*fault};
    Result<WmtsGrid> own = projected_grid_of(set, limits, bounds);
    return own ? own : Error{*fault};
  }
  WmtsGrid placed;
  placed.body = body.value_or(crs->body);
  const WmtsMatrix& finest = set.matrices.back();
  const int steps = static_cast<int>(set.matrices.size()) - 1;
  placed.grid.projection = mercator ? Projection::web_mercator : Projection::equirectangular;
  const double span = mercator ? mercator_span_deg(finest) : finest_span_deg(finest, placed.body);
  const Placing placing{.set = set,
                        .corner = mercator ? mercator_corner_of(finest) : corner_of(finest, crs->latitude_first),
                        .top_deg = top_row_deg(placed.grid),
                        .root_span = std::ldexp(span, steps)};
  if (mercator && !begins_at_square(placing.corner)) {
    return Error{fmt::format("in Web Mercator its tiles must begin at (-20037508.34, 20037508.34), not at ({}, {})",
                             finest.corner.first, finest.corner.second)};
  }
  placed.grid.root_span_deg = placing.root_span;
  placed.grid.tile_px = finest.tile_px;
  placed.grid.latitude = crs->latitude;
  if (Status chosen = choose_levels(placing, limits, placed.grid); !chosen) return chosen.error();
  if (Status checked = check_grid(placed.grid, "its grid"); !checked) return checked.error();
  if (const auto roots = count_places(placed.grid, placed.grid.min_level); roots > kMaxRootTiles) {
    return Error{
        fmt::format("its coarsest usable level has {} tiles, at most {} can be root tiles", roots, kMaxRootTiles)};
  }
  name_levels(placing, placed);
  return placed;
}

}  // namespace terrella
