#include "streaming/remote/wms/wms_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "streaming/georeference/crs.h"
#include "streaming/georeference/crs_text.h"
#include "streaming/remote/crs_names.h"
#include "streaming/remote/web_address.h"
#include "streaming/remote/wmts/ogc_choices.h"
#include "streaming/sets/gpkg_schema.h"
#include "tiles/tile_range.h"

namespace terrella {
namespace {

constexpr int kTilePx = 512;
/// Finest level of a layer without a least scale: 0.3 m a pixel on Earth.
constexpr int kMaxLevel = 17;
/// Systems that are tried. A server may list thousands.
constexpr int kMaxTried = 100;

enum class Kind { degrees, body_degrees, web_mercator, other };

Kind kind_of(const std::string& crs) {
  if (is_web_mercator(crs)) return Kind::web_mercator;
  const Result<GeographicCrs> geographic = parse_crs(crs);
  if (!geographic) return Kind::other;
  return geographic->body == "earth" ? Kind::degrees : Kind::body_degrees;
}

/// Levels between the layer's scales, for a grid whose level 0 has `scale_0`.
void limit_levels(const WmsLayer& layer, double scale_0, TileGrid& grid) {
  constexpr double kSlack = 1e-3;
  grid.max_level = kMaxLevel;
  if (layer.min_scale) {
    grid.max_level = static_cast<int>(
        std::clamp(std::floor(std::log2(scale_0 / *layer.min_scale) + kSlack), 0.0, double{kMaxTileLevel}));
  }
  if (layer.max_scale) {
    const double first = std::ceil(std::log2(scale_0 / *layer.max_scale) - kSlack);
    grid.min_level = static_cast<int>(std::clamp(first, 0.0, static_cast<double>(grid.max_level)));
  }
  // Root tiles are always in memory. Coarser ones than the server draws are blank.
  while (grid.min_level > 0 && count_places(grid, grid.min_level) > kMaxRootTiles) --grid.min_level;
}

bool northing_first(const std::string& crs, const WmsLimits& limits) {
  if (!limits.version_1_3) return false;
  const Result<std::string> known = stated_crs(crs);
  const Result<bool> first = known ? is_northing_first(*known) : Result<bool>(false);
  return first && *first;
}

Result<WmsGrid> geodetic_grid(const WmsLayer& layer, const WmsLimits& limits, const std::string& crs,
                              const RemoteOptions& options) {
  const Result<GeographicCrs> known = parse_crs(crs);
  if (!known) return known.error();
  WmsGrid placed{
      .crs = crs, .northing_first = northing_first(crs, limits), .grid = {}, .square = {}, .body = known->body};
  placed.grid.latitude = known->latitude;
  placed.grid.root_span_deg = options.root_span_deg.value_or(180.0);
  placed.grid.bounds = layer.bounds.value_or(GeoRect{});
  return placed;
}

WmsGrid mercator_grid(const WmsLayer& layer, const std::string& crs) {
  WmsGrid placed{.crs = crs, .northing_first = false, .grid = {}, .square = {}, .body = "earth"};
  placed.grid.projection = Projection::web_mercator;
  placed.grid.root_span_deg = 360.0;
  placed.grid.bounds = layer.bounds.value_or(GeoRect{});
  const auto within = [](Angle latitude) {
    return Angle::degrees(std::clamp(latitude.deg(), -kMercatorEndDeg, kMercatorEndDeg));
  };
  placed.grid.bounds.south = within(placed.grid.bounds.south);
  placed.grid.bounds.north = within(placed.grid.bounds.north);
  return placed;
}

Result<WmsGrid> projected_grid(const WmsLayer& layer, const WmsLimits& limits, const std::string& crs) {
  const Result<std::string> text = stated_crs(crs);
  if (!text) return text.error();
  const Result<Crs> known = Crs::open(*text);
  if (!known) return known.error();
  if (known->facts().geographic) return Error{"its degrees are on a body that is not known"};
  const auto box = std::ranges::find_if(layer.boxes, [&](const WmsBox& one) { return same_letters(one.crs, crs); });
  if (box == layer.boxes.end()) return Error{"the layer gives no BoundingBox for it"};
  WmsGrid placed{.crs = crs, .northing_first = northing_first(crs, limits), .grid = {}, .square = {}, .body = {}};
  const bool swapped = placed.northing_first;
  const double west = swapped ? box->low_second : box->low_first;
  const double east = swapped ? box->high_second : box->high_first;
  const double south = swapped ? box->low_first : box->low_second;
  const double north = swapped ? box->high_first : box->high_second;
  const double side = std::max(east - west, north - south);
  const CrsFacts& facts = known->facts();
  placed.body = known->is_earth() ? "earth" : fmt::format("{},{:.17g}", facts.a_m, (facts.a_m - facts.b_m) / facts.a_m);
  placed.square = CrsSquare{.crs = *text, .west = west, .north = north, .unit_per_deg = side / 360.0};
  placed.grid.projection = Projection::projected;
  placed.grid.root_span_deg = 360.0;
  placed.grid.bounds = {.west = Angle::degrees(-180.0),
                        .south = Angle::degrees(180.0 - 360.0 * (north - south) / side),
                        .east = Angle::degrees(-180.0 + 360.0 * (east - west) / side),
                        .north = Angle::degrees(180.0)};
  return placed;
}

Result<WmsGrid> grid_in(const WmsLayer& layer, const WmsLimits& limits, const std::string& crs,
                        const RemoteOptions& options) {
  Result<WmsGrid> placed = kind_of(crs) == Kind::web_mercator ? mercator_grid(layer, crs)
                           : kind_of(crs) == Kind::other      ? projected_grid(layer, limits, crs)
                                                              : geodetic_grid(layer, limits, crs, options);
  if (!placed) return placed;
  TileGrid& grid = placed->grid;
  const int most_px = limits.max_side_px > 0 ? limits.max_side_px : kTilePx;
  grid.tile_px = options.tile_px.value_or(std::min(kTilePx, most_px));
  if (limits.max_side_px > 0 && grid.tile_px > most_px) {
    return Error{fmt::format("its server makes pictures of at most {} pixels a side, not {}", most_px, grid.tile_px)};
  }
  const double unit_m = grid.projection == Projection::equirectangular
                            ? kMercatorDegree_m
                            : units_of(grid.projection, placed->square).per_deg;
  limit_levels(layer, grid.root_span_deg * unit_m / grid.tile_px / kOgcPixel_m, grid);
  return placed;
}

/// The layer's systems in the order in which they are tried.
std::vector<std::string> in_order(const WmsLayer& layer, const RemoteOptions& options) {
  std::vector<std::string> ordered;
  std::vector<Kind> kinds = {Kind::degrees, Kind::body_degrees, Kind::web_mercator, Kind::other};
  if (options.projection == Projection::web_mercator) kinds = {Kind::web_mercator};
  if (options.projection == Projection::equirectangular) kinds = {Kind::degrees, Kind::body_degrees};
  for (const Kind kind : kinds) {
    for (const std::string& crs : layer.crs) {
      if (kind_of(crs) == kind && std::ranges::find(ordered, crs) == ordered.end()) ordered.push_back(crs);
    }
  }
  const auto first =
      std::ranges::find_if(ordered, [](const std::string& crs) { return same_letters(crs, "EPSG:4326"); });
  if (first != ordered.end()) std::rotate(ordered.begin(), first, first + 1);
  return ordered;
}

}  // namespace

Result<WmsGrid> choose_wms_grid(const WmsLayer& layer, const WmsLimits& limits, const std::string& wanted,
                                const RemoteOptions& options) {
  if (!wanted.empty()) {
    const auto listed =
        std::ranges::find_if(layer.crs, [&](const std::string& crs) { return same_letters(crs, wanted); });
    if (listed != layer.crs.end()) {
      Result<WmsGrid> placed = grid_in(layer, limits, *listed, options);
      return placed ? placed : Error{fmt::format("{}: {}", wanted.substr(0, 100), placed.error().message)};
    }
    return Error{fmt::format("it is not offered in {}, but in {}", wanted.substr(0, 100), list_of(layer.crs))};
  }
  std::string reasons;
  int tried = 0;
  for (const std::string& crs : in_order(layer, options)) {
    if (++tried > kMaxTried) break;
    Result<WmsGrid> placed = grid_in(layer, limits, crs, options);
    if (placed) return placed;
    if (tried <= 3) reasons += fmt::format("; {}: {}", crs.substr(0, 60), placed.error().message);
  }
  return Error{fmt::format("none of its coordinate systems can be drawn ({}){}", list_of(layer.crs), reasons)};
}

}  // namespace terrella
