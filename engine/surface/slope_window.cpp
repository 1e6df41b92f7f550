#include "surface/slope_window.h"

#include <algorithm>
#include <cmath>

#include "surface/patch_mesh.h"

namespace terrella {
namespace {

constexpr double kPixelsPerSlope = 2.0;
// A window of more tiles, or of more heights, takes a coarser level.
constexpr double kMostTiles = 6.0, kMostHeights = 1536.0;
// A slanted pixel of at most this many texels keeps its level: more texels would be left out.
constexpr double kLongPixel_texels = 2.0;

bool counts_alike(const TileGrid& a, const TileGrid& b) {
  return a.projection == b.projection && a.latitude == b.latitude;
}

double height_row_deg(const TileGrid& heights, const PatchTree& tree, double row_deg) {
  if (counts_alike(heights, tree.grid())) return row_deg;
  const Angle lat = latitude_of_row(tree.grid(), tree.ellipsoid(), row_deg);
  return row_latitude_deg(heights, tree.ellipsoid(), Ellipsoid::normal(lat, Angle{}));
}

double wanted_level(const Relief& relief, const PatchTree& tree, const SelectedPatch& patch) {
  const TileGrid& grid = relief.grid();
  const double root_texel_m = Angle::degrees(tile_span_deg(grid, 0) / grid.tile_px).rad() * tree.ellipsoid().a_m();
  const double slant = std::max(1.0, patch.footprint_texels / kLongPixel_texels);
  return std::ceil(std::log2(root_texel_m / (kPixelsPerSlope * patch.pixel_m * std::sqrt(slant))));
}

}  // namespace

SlopeWindow slope_window(const Relief& relief, const PatchTree& tree, const SelectedPatch& patch) {
  const TileGrid& grid = relief.grid();
  const PatchNode& node = *patch.node;
  const double wanted = wanted_level(relief, tree, patch);
  SlopeWindow window;
  window.level = static_cast<int>(std::clamp(wanted, double(grid.min_level), double(kMaxTileLevel)));
  const double west = node.lon_center_deg + node.west_deg, east = node.lon_center_deg + node.east_deg;
  const double north = height_row_deg(grid, tree, node.north_row_deg);
  const double south = height_row_deg(grid, tree, node.south_row_deg);
  const double most_tiles = std::max(kMostTiles, kMostHeights / grid.tile_px);
  const double most_deg = std::max(east - west, north - south);
  while (window.level > grid.min_level && most_deg > most_tiles * tile_span_deg(grid, window.level)) --window.level;
  const TileXY nw = tile_xy(grid, window.level, north, west), se = tile_xy(grid, window.level, south, east);
  const auto within = [](double at, std::int64_t count) {
    return std::clamp(static_cast<std::int64_t>(std::floor(at)), std::int64_t{0}, count - 1);
  };
  const int finer = std::max(0, window.level - grid.max_level);
  const std::int64_t across = columns(grid, window.level - finer) << finer;
  const std::int64_t down = rows(grid, window.level - finer) << finer;
  window.x0 = within(nw.x, across);
  window.y0 = within(nw.y, down);
  window.w = static_cast<int>(within(se.x, across) - window.x0) + 1;
  window.h = static_cast<int>(within(se.y, down) - window.y0) + 1;
  const TileXY center =
      tile_xy(grid, window.level, height_row_deg(grid, tree, node.row_center_deg), node.lon_center_deg);
  const double per_deg = 1.0 / tile_span_deg(grid, window.level);
  window.center_and_scale =
      glm::vec4(center.x - static_cast<double>(window.x0), center.y - static_cast<double>(window.y0), per_deg, per_deg);
  return window;
}

std::vector<glm::vec2> height_offsets_deg(const TileGrid& heights, const PatchTree& tree, const PatchNode& node) {
  std::vector<glm::vec2> offsets;
  const int n = tree.segments();
  const double center_deg = height_row_deg(heights, tree, node.row_center_deg);
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i) {
      const EcefDir normal = patch_point(node.id, i, j, n, tree.mapping());
      const bool at_pole = normal.xyz.x == 0.0 && normal.xyz.y == 0.0;
      const double lon_deg = Ellipsoid::lat_lon(normal).lon.deg() - node.lon_center_deg;
      offsets.emplace_back(at_pole ? 0.0 : wrapped_deg(lon_deg),
                           row_latitude_deg(heights, tree.ellipsoid(), normal) - center_deg);
    }
  }
  return offsets;
}

}  // namespace terrella
