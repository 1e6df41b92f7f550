#include "streaming/remote/wmts/wmts_projected.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "streaming/georeference/crs.h"
#include "streaming/georeference/crs_text.h"
#include "streaming/georeference/figure.h"
#include "streaming/remote/wmts/ogc_choices.h"
#include "streaming/sets/crs_levels.h"
#include "streaming/sets/gpkg_schema.h"
#include "tiles/grid_ranges.h"
#include "tiles/tile_range.h"

namespace terrella {
namespace {

/// Largest distance of a tile from its place in a quadtree, in texels. It is invisible.
constexpr double kQuadSlack_px = 0.05;

/// Matrices that become levels, coarsest first.
struct Matrices {
  std::vector<std::string> names;
  std::vector<CrsLevel> places;
  WmtsLimits data;  ///< tiles of the finest matrix that the layer has
  int tile_px = 0;
};

double span_of(const CrsLevel& level, int tile_px) { return level.unit_per_px * tile_px; }

/// True if a coarse matrix has the area of a fine one. The outer tiles of a fine matrix may reach beyond its data.
bool covers_area_of(const CrsLevel& coarse, const CrsLevel& fine, int tile_px) {
  const double slack = std::max(coarse.unit_per_px, span_of(fine, tile_px));
  const auto east = [&](const CrsLevel& level) {
    return level.west + static_cast<double>(level.columns) * span_of(level, tile_px);
  };
  const auto south = [&](const CrsLevel& level) {
    return level.north - static_cast<double>(level.rows) * span_of(level, tile_px);
  };
  return coarse.west <= fine.west + slack && coarse.north >= fine.north - slack && east(coarse) >= east(fine) - slack &&
         south(coarse) <= south(fine) + slack;
}

CrsLevel place_of_matrix(const WmtsMatrix& matrix, const WmtsLimits* limits, double unit_m, bool northing_first) {
  const auto [first, second] = matrix.corner;
  CrsLevel place{.west = northing_first ? second : first,
                 .north = northing_first ? first : second,
                 .unit_per_px = matrix.scale_denominator * kOgcPixel_m / unit_m,
                 .columns = matrix.columns,
                 .rows = matrix.rows};
  if (limits != nullptr) {
    place.columns = std::min(place.columns, limits->last_column + 1);
    place.rows = std::min(place.rows, limits->last_row + 1);
  }
  return place;
}

/// Chooses the finest matrices that the limits list, and coarser ones while each covers the finest.
Result<Matrices> choose_matrices(const WmtsMatrixSet& set, const std::vector<WmtsLimits>& limits, double unit_m,
                                 bool northing_first) {
  Matrices chosen;
  for (auto matrix = set.matrices.rbegin(); matrix != set.matrices.rend(); ++matrix) {
    const WmtsLimits* said = limits_of(limits, matrix->name);
    if (said == nullptr && !limits.empty()) {
      if (chosen.names.empty()) continue;
      break;
    }
    const CrsLevel place = place_of_matrix(*matrix, said, unit_m, northing_first);
    if (chosen.names.empty()) {
      chosen.tile_px = matrix->tile_px;
      chosen.data = {.matrix = matrix->name, .last_column = place.columns - 1, .last_row = place.rows - 1};
      if (said != nullptr) {
        chosen.data.first_column = std::min(said->first_column, place.columns - 1);
        chosen.data.first_row = std::min(said->first_row, place.rows - 1);
      }
    } else if (matrix->tile_px != chosen.tile_px || !covers_area_of(place, chosen.places.front(), chosen.tile_px)) {
      break;
    }
    if (chosen.names.size() > kMaxTileLevel) break;
    chosen.names.push_back(matrix->name);
    chosen.places.push_back(place);
  }
  if (chosen.names.empty()) return Error{"none of its matrices is in the layer's TileMatrixSetLimits"};
  std::ranges::reverse(chosen.names);
  std::ranges::reverse(chosen.places);
  return chosen;
}

/// True if all matrices are the finest halved some times, from one corner.
bool is_quadtree(const Matrices& matrices) {
  const CrsLevel& finest = matrices.places.back();
  for (std::size_t i = 0; i < matrices.places.size(); ++i) {
    const CrsLevel& level = matrices.places[i];
    const double exact = std::ldexp(finest.unit_per_px, static_cast<int>(matrices.places.size() - 1 - i));
    const double texels = static_cast<double>(std::max(level.columns, level.rows)) * matrices.tile_px;
    const double off = std::max(std::abs(level.west - finest.west), std::abs(level.north - finest.north));
    if (!(std::abs(level.unit_per_px / exact - 1.0) * texels <= kQuadSlack_px)) return false;
    if (!(off <= kQuadSlack_px * finest.unit_per_px)) return false;
  }
  return true;
}

/// The quadtree over the square from the common corner.
void place_quadtree(const Matrices& matrices, WmtsGrid& placed) {
  const CrsLevel& finest = matrices.places.back();
  const std::size_t last = matrices.places.size() - 1;
  const auto roots = static_cast<double>(halved_up(longer_side(finest), last));
  const double root = std::ldexp(span_of(finest, matrices.tile_px), static_cast<int>(last));
  placed.square->levels.clear();
  placed.square->unit_per_deg = root * roots / 360.0;
  placed.grid.root_span_deg = 360.0 / roots;
  const double span = tile_span_deg(placed.grid, static_cast<int>(last));
  const auto x = [&](std::int64_t tiles) { return std::min(static_cast<double>(tiles) * span - 180.0, 180.0); };
  const WmtsLimits& data = matrices.data;
  placed.grid.bounds = {.west = Angle::degrees(x(data.first_column)),
                        .south = Angle::degrees(-x(data.last_row + 1)),
                        .east = Angle::degrees(x(data.last_column + 1)),
                        .north = Angle::degrees(-x(data.first_row))};
}

Status check_places(const Matrices& matrices) {
  const CrsLevel& coarsest = matrices.places.front();
  const double roots = static_cast<double>(coarsest.columns) * static_cast<double>(coarsest.rows);
  if (roots > kMaxRootTiles) {
    return Error{fmt::format("its coarsest usable level, \"{}\", has {:.12g} tiles, at most {} can be root tiles",
                             matrices.names.front(), roots, kMaxRootTiles)};
  }
  for (const CrsLevel& level : matrices.places) {
    const double far = std::abs(level.west) + std::abs(level.north) +
                       static_cast<double>(longer_side(level)) * span_of(level, matrices.tile_px);
    constexpr double kFarthest = 1e12;  // units; beyond it a double has no millimetres
    if (!(level.unit_per_px > 0.0 && far < kFarthest)) {
      return Error{"its matrices reach farther than any coordinate; a ScaleDenominator or TopLeftCorner is wrong"};
    }
  }
  return Done{};
}

}  // namespace

double metres_of_axis(const CrsFacts& facts) {
  return facts.geographic ? facts.unit_deg * kMercatorDegree_m : facts.unit_m;
}

Result<WmtsGrid> placed_grid_of(const WmtsMatrixSet& set, const std::vector<WmtsLimits>& limits,
                                const WmtsSystem& system, bool northing_first) {
  const Result<Matrices> matrices = choose_matrices(set, limits, system.unit_m, northing_first);
  if (!matrices) return matrices.error();
  if (Status good = check_places(*matrices); !good) return good.error();
  TileSetInfo info;
  info.grid.tile_px = matrices->tile_px;
  place_own_levels(system.text, matrices->places, info);
  WmtsGrid placed{.grid = info.grid,
                  .level_names = matrices->names,
                  .shifts = {},
                  .body = body_name(system.crs.facts()),
                  .square = info.square};
  if (is_quadtree(*matrices)) place_quadtree(*matrices, placed);
  if (Status good = check_grid(placed.grid, "its grid"); !good) return good.error();
  return placed;
}

Result<WmtsGrid> projected_grid_of(const WmtsMatrixSet& set, const std::vector<WmtsLimits>& limits,
                                   const std::optional<GeoRect>& bounds) {
  const Result<std::string> text = stated_crs(set.crs);
  if (!text) return text.error();
  const Result<Crs> crs = Crs::open(*text);
  if (!crs) return Error{fmt::format("{} ({})", crs.error().message, text->substr(0, 100))};
  const WmtsSystem system{.crs = *crs, .text = *text, .unit_m = metres_of_axis(crs->facts())};
  if (!(system.unit_m > 0.0)) return Error{"PROJ does not say the unit of its coordinate system"};
  return placed_grid_of(set, limits, system, has_northing_first(set, system, bounds));
}

}  // namespace terrella
