#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "surface/patch_tree.h"

// The windows of patches: the tiles that a patch lies on.
namespace terrella {
namespace {

// The point of a patch's extent at fractions of its longitude and row range.
glm::dvec3 extent_point(const PatchTree& tree, const PatchNode& node, double lon_deg, double row_deg) {
  const Angle lat = latitude_of_row(tree.grid(), tree.ellipsoid(), row_deg);
  return tree.ellipsoid().position(Ellipsoid::normal(lat, Angle::degrees(lon_deg + node.lon_center_deg))).xyz_m;
}

// Patch borders on tile borders must not claim the tile beyond: a millionth of a tile is 0.0003 of a texel.
constexpr double kSliver = 1e-6;

struct WindowRows {
  std::int64_t first, end;
};

// The rows of tiles that a patch lies on. A patch narrower than the sliver at the planet's edge lies on the last tile.
WindowRows window_rows(const TileGrid& grid, const PatchNode& node, int level) {
  const double north = tile_xy(grid, level, node.north_row_deg, 0.0).y;
  const double south = tile_xy(grid, level, node.south_row_deg, 0.0).y;
  const std::int64_t first = std::min(static_cast<std::int64_t>(std::floor(north + kSliver)), rows(grid, level) - 1);
  return {first, std::max(first + 1, static_cast<std::int64_t>(std::ceil(south - kSliver)))};
}

// Longitudes relative to the patch's centre, and rows.
struct Extent {
  double west_deg, east_deg, south_deg, north_deg;
  [[nodiscard]] double lon_deg(double part) const { return west_deg + part * (east_deg - west_deg); }
  [[nodiscard]] double row_deg(double part) const { return south_deg + part * (north_deg - south_deg); }
};

Extent cell_extent(const PatchTree& tree, const PatchNode& node, const TileWindow& win, int x, int y) {
  const TileBounds cell = tile_bounds(tree.grid(), TileId{win.level, win.x0 + x, win.y0 + y, win.squeeze});
  return {std::max(cell.west_deg - node.lon_center_deg, node.west_deg),
          std::min(cell.east_deg - node.lon_center_deg, node.east_deg), std::max(cell.south_deg, node.south_row_deg),
          std::min(cell.north_deg, node.north_row_deg)};
}

BoundingSphere cell_sphere(const PatchTree& tree, const PatchNode& node, const Extent& cell) {
  BoundingSphere sphere{extent_point(tree, node, cell.lon_deg(0.5), cell.row_deg(0.5)), 0.0};
  for (int k = 0; k < 9; ++k) {
    const int column = k % 3, row = k / 3;
    const glm::dvec3 p = extent_point(tree, node, cell.lon_deg(0.5 * column), cell.row_deg(0.5 * row));
    sphere.radius_m = std::max(sphere.radius_m, glm::length(p - sphere.center_m));
  }
  return sphere;
}

SurfaceLattice lattice_over(const PatchTree& tree, const PatchNode& node, const Extent& cell) {
  SurfaceLattice lattice;
  lattice.points_m.reserve(static_cast<std::size_t>(kLatticeQuads + 1) * (kLatticeQuads + 1));
  for (int j = 0; j <= kLatticeQuads; ++j) {
    for (int i = 0; i <= kLatticeQuads; ++i) {
      lattice.points_m.push_back(
          extent_point(tree, node, cell.lon_deg(double(i) / kLatticeQuads), cell.row_deg(double(j) / kLatticeQuads)));
    }
  }
  // Sagittas of a quad's sides: of a parallel by its own radius, of a meridian by the least radius of curvature, b²/a;
  // a tenth more, as an arc of a few degrees is no parabola.
  const Ellipsoid& e = tree.ellipsoid();
  double parallel_m = 0.0, side_m = 0.0;
  for (std::size_t k = 0; k < lattice.points_m.size(); ++k) {
    const glm::dvec3& p = lattice.points_m[k];
    parallel_m = std::max(parallel_m, std::hypot(p.x, p.y));
    if (k > kLatticeQuads) side_m = std::max(side_m, glm::length(p - lattice.points_m[k - kLatticeQuads - 1]));
  }
  const double step_rad = (cell.east_deg - cell.west_deg) / kLatticeQuads * (std::numbers::pi / 180.0);
  lattice.bulge_m = 1.1 / 8.0 * (parallel_m * step_rad * step_rad + side_m * side_m * e.a_m() / (e.b_m() * e.b_m()));
  return lattice;
}

}  // namespace

int PatchTree::window_squeeze(const PatchNode& node, int tile_level) const {
  if (!grid_.reduced) return 0;
  const WindowRows span = window_rows(grid_, node, tile_level);
  // Rows are squeezed more and more from the equator to a pole.
  return std::min(squeeze_of_row(grid_, tile_level, span.first), squeeze_of_row(grid_, tile_level, span.end - 1));
}

TileWindow PatchTree::make_window(const PatchNode& node, int tile_level, int squeeze) const {
  TileWindow win;
  const WindowRows span = window_rows(grid_, node, tile_level);
  win.level = tile_level;
  win.squeeze = squeeze;
  win.y0 = span.first;
  win.h = static_cast<int>(span.end - span.first);
  const double west = tile_xy(grid_, tile_level, 0.0, node.lon_center_deg + node.west_deg).x;
  const double east = tile_xy(grid_, tile_level, 0.0, node.lon_center_deg + node.east_deg).x;
  const std::int64_t last = squeezed_columns(grid_, tile_level, win.squeeze) - 1;
  win.x0 = std::min(static_cast<std::int64_t>(std::floor(std::ldexp(west + kSliver, -win.squeeze))), last);
  const auto end = static_cast<std::int64_t>(std::ceil(std::ldexp(east - kSliver, -win.squeeze)));
  win.w = static_cast<int>(std::max(win.x0 + 1, end) - win.x0);
  win.cells.reserve(static_cast<std::size_t>(win.w) * static_cast<std::size_t>(win.h));
  for (int y = 0; y < win.h; ++y) {
    for (int x = 0; x < win.w; ++x) {
      const BoundingSphere whole = cell_sphere(*this, node, cell_extent(*this, node, win, x, y));
      win.cells.push_back({whole, ellipsoid_.surface_normal({whole.center_m}).xyz, {}});
    }
  }
  return win;
}

SurfaceLattice PatchTree::make_lattice(const PatchNode& node, const TileWindow& window, int x, int y) const {
  return lattice_over(*this, node, cell_extent(*this, node, window, x, y));
}

}  // namespace terrella
