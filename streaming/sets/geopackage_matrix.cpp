#include "streaming/sets/geopackage_matrix.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "tiles/grid_ranges.h"

namespace terrella {
namespace {

constexpr std::size_t kMaxMatrices = 64;
constexpr std::int64_t kMaxZoom = 60;
/// Largest distance of a tile from its place in the grid, in texels. It is invisible and allows for rounded decimals.
constexpr double kSlackTexels = 0.1;

struct MatrixRow {
  std::optional<std::int64_t> zoom, columns, rows, width_px, height_px;
  std::optional<double> pixel_x_deg, pixel_y_deg;
};

MatrixRow get_row(const SqliteQuery& query, double unit_deg) {
  const auto degrees = [&](int column) {
    const std::optional<double> units = query.number(column);
    return units ? std::optional(*units * unit_deg) : std::nullopt;
  };
  return {query.integer(0), query.integer(1), query.integer(2), query.integer(3),
          query.integer(4), degrees(5),       degrees(6)};
}

bool in_range(const std::optional<std::int64_t>& value, std::int64_t low, std::int64_t high) {
  return value && *value >= low && *value <= high;
}

/// Fault of a single row.
std::optional<std::string> fault_of(const MatrixRow& row, double unit_deg) {
  constexpr auto kMost = static_cast<std::int64_t>(kMaxTilesASide);
  if (!in_range(row.zoom, 0, kMaxZoom)) return fmt::format("a zoom_level is not a whole number in [0, {}]", kMaxZoom);
  const auto of_zoom = [&](const std::string& text) { return fmt::format("at zoom_level {} {}", *row.zoom, text); };
  if (!in_range(row.columns, 1, kMost) || !in_range(row.rows, 1, kMost)) {
    return of_zoom(fmt::format("matrix_width or matrix_height is not a whole number in [1, {}]", kMost));
  }
  if (!in_range(row.width_px, kMinTilePx, kMaxTilePx) || row.height_px != row.width_px) {
    return of_zoom(
        fmt::format("tile_width and tile_height are not the same number in [{}, {}]", kMinTilePx, kMaxTilePx));
  }
  if (!row.pixel_x_deg || !row.pixel_y_deg || *row.pixel_x_deg <= 0.0 || *row.pixel_y_deg <= 0.0) {
    return of_zoom("pixel_x_size or pixel_y_size is not a positive number");
  }
  const double texels = static_cast<double>(std::max(*row.columns, *row.rows)) * static_cast<double>(*row.width_px);
  if (std::abs(*row.pixel_x_deg / *row.pixel_y_deg - 1.0) * texels > kSlackTexels) {
    return of_zoom(fmt::format(
        "pixels are not square: {:.9g} by {:.9g} units. Write it again with `gdalwarp -of GPKG -tr {:.9g} {:.9g}`",
        *row.pixel_x_deg / unit_deg, *row.pixel_y_deg / unit_deg, *row.pixel_y_deg / unit_deg,
        *row.pixel_y_deg / unit_deg));
  }
  return std::nullopt;
}

TileMatrix to_matrix(const MatrixRow& row) {
  return {.zoom = *row.zoom,
          .columns = *row.columns,
          .rows = *row.rows,
          .tile_px = static_cast<int>(*row.width_px),
          .span_deg = *row.pixel_x_deg * static_cast<double>(*row.width_px)};
}

/// True if the tiles fill the extent. They may reach over it by less than a tile, as in GDAL's coarse overviews and
/// clipped quadtrees.
bool fills(std::int64_t tiles, double span_deg, double extent_deg, double slack_deg) {
  const auto count = static_cast<double>(tiles);
  return count * span_deg >= extent_deg - slack_deg && (count - 1.0) * span_deg <= extent_deg + slack_deg;
}

std::optional<std::string> fault_in_extent(const TileMatrix& matrix, const Extent& extent, double unit_deg) {
  const double slack_deg = kSlackTexels * matrix.span_deg / matrix.tile_px;
  const double width_deg = extent.east - extent.west;
  const double height_deg = extent.north - extent.south;
  if (fills(matrix.columns, matrix.span_deg, width_deg, slack_deg) &&
      fills(matrix.rows, matrix.span_deg, height_deg, slack_deg)) {
    return std::nullopt;
  }
  return fmt::format(
      "zoom_level {} has {}×{} tiles of {:.9g} units, which do not fill the {:.9g}×{:.9g} of "
      "gpkg_tile_matrix_set",
      matrix.zoom, matrix.columns, matrix.rows, matrix.span_deg / unit_deg, width_deg / unit_deg,
      height_deg / unit_deg);
}

/// Number of halvings between a matrix and the finest; nullopt if the ratio is no power of two.
std::optional<int> halvings(const TileMatrix& matrix, const TileMatrix& finest) {
  const double steps = std::log2(matrix.span_deg / finest.span_deg);
  const int whole = static_cast<int>(std::lround(steps));
  const double stretch = std::abs(std::ldexp(finest.span_deg, whole) / matrix.span_deg - 1.0);
  const double texels = static_cast<double>(std::max(matrix.columns, matrix.rows)) * matrix.tile_px;
  return stretch * texels <= kSlackTexels ? std::optional(whole) : std::nullopt;
}

std::optional<std::string> fault_among(const std::vector<TileMatrix>& matrices, double unit_deg) {
  const TileMatrix& finest = matrices.front();
  for (std::size_t i = 1; i < matrices.size(); ++i) {
    const TileMatrix& coarser = matrices[i];
    if (coarser.tile_px != finest.tile_px) return "its zoom levels have tiles of different sizes in pixels";
    if (coarser.span_deg == matrices[i - 1].span_deg || !halvings(coarser, finest)) {
      return fmt::format(
          "its zoom levels do not halve: a tile spans {:.9g} units at zoom_level {} and {:.9g} at zoom_level {}. Write "
          "it again with `gdal_translate -of GPKG`, without a TILING_SCHEME",
          coarser.span_deg / unit_deg, coarser.zoom, matrices[i - 1].span_deg / unit_deg, matrices[i - 1].zoom);
    }
  }
  return std::nullopt;
}

/// Number of whole tiles from the grid's origin to the matrix' corner; nullopt if the corner lies between tiles.
std::optional<std::int64_t> whole_tiles(double offset_deg, const TileMatrix& matrix) {
  const double tiles = offset_deg / matrix.span_deg;
  if (std::abs(tiles) > kMaxTilesASide) return std::nullopt;
  const double whole = std::round(tiles);
  return std::abs(tiles - whole) * matrix.tile_px <= kSlackTexels ? std::optional(std::llround(whole)) : std::nullopt;
}

std::optional<GeoPackageLevel> place(const TileMatrix& matrix, const Extent& extent, const TileGrid& grid) {
  const auto first_column = whole_tiles(extent.west - grid.west_deg, matrix);
  const auto first_row = whole_tiles(top_row_deg(grid) - extent.north, matrix);
  if (!first_column || !first_row) return std::nullopt;
  const bool goes_round = grid.projection != Projection::projected;
  return GeoPackageLevel{.zoom = matrix.zoom,
                         .columns = matrix.columns,
                         .rows = matrix.rows,
                         .first_column = *first_column,
                         .first_row = *first_row,
                         .turn_columns = goes_round ? whole_tiles(360.0, matrix).value_or(0) : 0};
}

/// Moves the grid's origin to a corner of the tiles, if the tiles of a region do not begin a whole number of tiles from
/// the planet's corner. All levels share the corner.
void place_origin(const std::vector<TileMatrix>& matrices, const Extent& extent, TileGrid& grid) {
  if (grid.projection == Projection::web_mercator || grid.projection == Projection::projected) return;
  const double step = matrices.back().span_deg;
  if (!whole_tiles(grid.north_deg - extent.north, matrices.front())) {
    grid.north_deg = extent.north + std::ceil((90.0 - extent.north) / step) * step;
  }
  const bool is_region = extent.east - extent.west < 360.0 && extent.east <= 180.0;
  if (is_region && !whole_tiles(extent.west - grid.west_deg, matrices.front())) {
    grid.west_deg = extent.west - std::ceil((extent.west + 180.0) / step) * step;
  }
}

Error between_tiles(const Extent& extent, const TileMatrix& finest, double top_deg, const std::string& where) {
  if (top_deg > 90.0) {
    return Error{fmt::format(
        "{}: its tiles in Web Mercator are not those that web maps have (level 0 the whole square, each level half of "
        "the one before). Write it again with gdal_translate -of GPKG -co TILING_SCHEME=GoogleMapsCompatible",
        where)};
  }
  return Error{fmt::format(
      "{}: its tiles go round the planet and begin at ({}°, {}°), which is no whole number of tiles ({}°) from "
      "(-180°, 90°). Write it again with "
      "gdal_translate -of GPKG -co TILING_SCHEME=InspireCRS84Quad, or cut the picture itself with ‹cut›",
      where, extent.west, extent.north, finest.span_deg)};
}

/// Level of the finest matrix: its zoom, unless the root tile then has no sensible size.
int level_of_finest(const TileMatrix& finest, int coarsest_steps) {
  const double root_deg = std::ldexp(finest.span_deg, static_cast<int>(finest.zoom));
  const bool sensible = finest.zoom <= kMaxTileLevel && finest.zoom >= coarsest_steps && root_deg <= kMaxRootSpanDeg &&
                        root_deg >= kMinRootSpanDeg;
  if (sensible) return static_cast<int>(finest.zoom);
  const int below_360 = static_cast<int>(std::floor(std::log2(360.0 / finest.span_deg)));
  return std::clamp(std::max(below_360, coarsest_steps), 0, kMaxTileLevel);
}

}  // namespace

Result<std::vector<TileMatrix>> read_matrices(SqliteReader& reader, const MatrixTable& table, const Extent& extent,
                                              const std::string& where) {
  const auto refuse = [&](const std::string& why) {
    return Error{fmt::format("{}: table \"{}\": {}", where, table.name, why)};
  };
  Result<SqliteQuery, SqlError> query = reader.prepare(
      "SELECT zoom_level, matrix_width, matrix_height, tile_width, tile_height, pixel_x_size, pixel_y_size FROM "
      "gpkg_tile_matrix WHERE table_name = ?1");
  if (!query) return refuse("gpkg_tile_matrix: " + query.error().message);
  query->bind(1, table.name);
  std::vector<TileMatrix> matrices;
  while (true) {
    const Result<bool, SqlError> more = query->step();
    if (!more) return refuse("gpkg_tile_matrix: " + more.error().message);
    if (!*more) break;
    if (matrices.size() == kMaxMatrices) return refuse(fmt::format("more than {} zoom levels", kMaxMatrices));
    const MatrixRow row = get_row(*query, table.unit_deg);
    if (const auto fault = fault_of(row, table.unit_deg)) return refuse(*fault);
    matrices.push_back(to_matrix(row));
    if (const auto fault = fault_in_extent(matrices.back(), extent, table.unit_deg)) return refuse(*fault);
  }
  if (matrices.empty()) return refuse("gpkg_tile_matrix has no zoom level of it");
  std::sort(matrices.begin(), matrices.end(),
            [](const TileMatrix& a, const TileMatrix& b) { return a.span_deg < b.span_deg; });
  if (const auto fault = fault_among(matrices, table.unit_deg)) return refuse(*fault);
  return matrices;
}

Status place_on_grid(const std::vector<TileMatrix>& matrices, const Extent& extent, GeoPackageTiles& tiles,
                     const std::string& where) {
  std::vector<std::pair<int, GeoPackageLevel>> placed;  // halvings to the finest, finest first
  place_origin(matrices, extent, tiles.info.grid);
  for (const TileMatrix& matrix : matrices) {
    const auto level = place(matrix, extent, tiles.info.grid);
    if (!level) break;  // a tile of twice the span does not fit either
    placed.emplace_back(*halvings(matrix, matrices.front()), *level);
  }
  const TileMatrix& finest = matrices.front();
  if (placed.empty()) return between_tiles(extent, finest, top_row_deg(tiles.info.grid), where);
  const int top = level_of_finest(finest, placed.back().first);
  TileGrid& grid = tiles.info.grid;
  grid.tile_px = finest.tile_px;
  grid.root_span_deg = std::ldexp(finest.span_deg, top);
  if (grid.projection == Projection::web_mercator) {
    // A span written in metres is 360° or a half, a quarter … of it, apart from rounding.
    const double exact = std::ldexp(360.0, -static_cast<int>(std::lround(std::log2(360.0 / grid.root_span_deg))));
    const double texels = std::ldexp(finest.tile_px, top);
    if (std::abs(grid.root_span_deg / exact - 1.0) * texels > kSlackTexels) {
      return between_tiles(extent, finest, top_row_deg(grid), where);
    }
    grid.root_span_deg = exact;
  }
  grid.max_level = top;
  grid.min_level = top - placed.back().first;
  for (const auto& [steps, level] : placed) tiles.levels[top - steps] = level;
  return Done{};
}

Status match_grid(const std::vector<TileMatrix>& matrices, const Extent& extent, GeoPackageTiles& tiles,
                  const std::string& where) {
  const TileGrid& grid = tiles.info.grid;
  for (int level = grid.min_level; level <= grid.max_level; ++level) {
    const double span_deg = tile_span_deg(grid, level);
    const auto same_span = [&](const TileMatrix& matrix) {
      const double texels = static_cast<double>(std::max(matrix.columns, matrix.rows)) * matrix.tile_px;
      return std::abs(matrix.span_deg / span_deg - 1.0) * texels <= kSlackTexels;
    };
    const auto found = std::find_if(matrices.begin(), matrices.end(), same_span);
    if (found == matrices.end() || found->tile_px != grid.tile_px) {
      return Error{
          fmt::format("{}: its description says level {} has tiles of {}° and {} pixels, gpkg_tile_matrix has none "
                      "such",
                      where, level, span_deg, grid.tile_px)};
    }
    const auto placed = place(*found, extent, grid);
    if (!placed) return between_tiles(extent, *found, top_row_deg(grid), where);
    tiles.levels[level] = *placed;
  }
  return Done{};
}

}  // namespace terrella
