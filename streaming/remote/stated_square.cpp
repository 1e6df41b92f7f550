#include "streaming/remote/stated_square.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "streaming/georeference/crs.h"
#include "streaming/georeference/crs_text.h"
#include "streaming/remote/wmts/matrix_set_json.h"
#include "streaming/remote/wmts/ogc_choices.h"
#include "streaming/remote/wmts/wmts_projected.h"
#include "streaming/sets/crs_levels.h"
#include "tiles/grid_ranges.h"
#include "tiles/tile_range.h"

namespace terrella {
namespace {

/// Units in a pixel of each level.
Result<std::vector<double>> stated_pixels(const StatedSquare& said, const RemoteOptions& options, int tile_px) {
  if (!said.resolutions.empty()) return said.resolutions;
  if (!options.max_level) {
    return Error{"it is not said how many levels it has; say ‹levels› 0-N (max_level in a description)"};
  }
  const double side = std::max(said.extent->east - said.extent->west, said.extent->north - said.extent->south);
  std::vector<double> pixels;
  pixels.reserve(static_cast<std::size_t>(*options.max_level) + 1);
  for (int level = 0; level <= *options.max_level; ++level) pixels.push_back(std::ldexp(side / tile_px, -level));
  return pixels;
}

/// The levels as a matrix set with the easting first.
WmtsMatrixSet matrices_of(const StatedSquare& said, const std::vector<double>& pixels, int tile_px, double unit_m) {
  WmtsMatrixSet set{.name = {}, .crs = said.crs, .matrices = {}, .box = {}};
  const CrsBounds& extent = *said.extent;
  const auto tiles = [](double length, double span) {
    return static_cast<std::int64_t>(std::min(kMaxTilesASide, tiles_over(length, span)));
  };
  set.matrices.reserve(pixels.size());
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const double span = pixels[i] * tile_px;
    set.matrices.push_back({.name = std::to_string(i),
                            .scale_denominator = pixels[i] * unit_m / kOgcPixel_m,
                            .corner = {extent.west, extent.north},
                            .tile_px = tile_px,
                            .columns = tiles(extent.east - extent.west, span),
                            .rows = tiles(extent.north - extent.south, span)});
  }
  return set;
}

Result<WmtsGrid> grid_of_extent(const StatedSquare& said, const RemoteOptions& options) {
  if (!said.extent)
    return Error{
        "‹crs› of its tiles needs ‹bounds› of them, west, south, east and north in that system (extent in a "
        "description)"};
  if (options.bounds) return Error{"bounds in degrees cannot stand beside the extent of its tiles, which bounds them"};
  const Result<std::string> text = stated_crs(said.crs);
  if (!text) return text.error();
  const Result<Crs> crs = Crs::open(*text);
  if (!crs) return Error{fmt::format("{} ({})", crs.error().message, text->substr(0, 100))};
  const int tile_px = options.tile_px.value_or(256);
  const auto pixels = stated_pixels(said, options, tile_px);
  if (!pixels) return pixels.error();
  const WmtsSystem system{.crs = *crs, .text = *text, .unit_m = metres_of_axis(crs->facts())};
  return placed_grid_of(matrices_of(said, *pixels, tile_px, system.unit_m), {}, system, false);
}

Result<WmtsGrid> grid_of_matrix_set(const std::string& text, const RemoteOptions& options) {
  const Result<WmtsMatrixSet> set = read_matrix_set_json(text);
  if (!set) return Error{"its tile_matrix_set: " + set.error().message};
  Result<WmtsGrid> placed = grid_of(*set, {}, options.body, options.bounds);
  return placed ? placed : Error{"its tile_matrix_set: " + placed.error().message};
}

}  // namespace

std::vector<TileShift> south_rows_of(const TileSetInfo& info) {
  std::vector<TileShift> shifts;
  shifts.reserve(static_cast<std::size_t>(info.grid.max_level) + 1);
  for (int level = 0; level <= info.grid.max_level; ++level) {
    const auto number = static_cast<std::size_t>(level);
    const bool own = number < info.square->levels.size();
    shifts.push_back(
        {.south_rows = own ? info.square->levels[number].rows : tile_places(info.grid, level).rows.last + 1});
  }
  return shifts;
}

Status place_on_stated_square(const RemoteOptions& options, RemoteTileSet& set) {
  const StatedSquare& said = *options.square;
  if (options.root_span_deg || options.projection) {
    return Error{"a crs or tile_matrix_set of its own cannot stand beside ‹root_span_deg› or ‹projection›"};
  }
  auto placed =
      said.matrix_set_json.empty() ? grid_of_extent(said, options) : grid_of_matrix_set(said.matrix_set_json, options);
  if (!placed) return placed.error();
  set.info.grid = placed->grid;
  set.info.square = std::move(placed->square);
  set.info.body = std::move(placed->body);
  set.level_names = std::move(placed->level_names);
  set.shifts = std::move(placed->shifts);
  if (Status same = check_tile_px(set.info.grid, options); !same) return same;
  if (set.info.square && set.url.with_secrets().find("{-y}") != std::string::npos) set.shifts = south_rows_of(set.info);
  return narrow_levels(set.info.grid, options);
}

}  // namespace terrella
