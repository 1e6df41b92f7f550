#include "scene/relief.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace terrella {
namespace {

// Heights are asked for at this many pixels a height: what lies between two of them is a plane anyhow.
constexpr double kPixelsPerHeight = 2.0;
// A patch that many tiles of a level lie under takes a coarser one.
constexpr std::int64_t kMostColumns = 6;
// The two grids may count rows by different latitudes: so far apart they are at most for f = 0.1, degrees.
constexpr double kLatitudeKinds_deg = 7.0;

double span_m(const Ellipsoid& e, const TileGrid& grid) {
  return e.a_m() * (std::numbers::pi / 180.0) * grid.root_span_deg / grid.tile_px;
}

}  // namespace

Relief::Relief(const Ellipsoid& ellipsoid, const TileGrid& grid, double exaggeration, std::size_t budget_bytes)
    : ellipsoid_(ellipsoid),
      field_(ellipsoid, grid),
      exaggeration_(exaggeration),
      most_tiles_(std::max<std::size_t>(64, budget_bytes / (sizeof(float) * static_cast<std::size_t>(grid.tile_px) *
                                                            static_cast<std::size_t>(grid.tile_px)))) {}

void Relief::add(HeightTile tile) {
  const double low = exaggeration_ * double(tile.min_m), high = exaggeration_ * double(tile.max_m);
  range_ = {.min_m = std::min(range_.min_m, low), .max_m = std::max(range_.max_m, high)};
  note_change(tile.id);
  last_wanted_[tile.id] = round_;
  field_.add(std::move(tile));
  keep_to_budget();
}

// A tile's heights reach half a pixel over its border, into what its neighbours serve.
void Relief::note_change(const TileId& id) {
  const TileBounds b = tile_bounds(grid(), id);
  const double pixel_deg = (b.east_deg - b.west_deg) / grid().tile_px;
  changes_.push_back({.west = b.west_deg - pixel_deg,
                      .east = b.east_deg + pixel_deg,
                      .south = b.south_deg - pixel_deg,
                      .north = b.north_deg + pixel_deg});
}

bool Relief::touches(const PatchTree& tree, const PatchNode& node, const Change& change) const {
  const bool same_rows = tree.grid().latitude == grid().latitude && tree.grid().projection == grid().projection;
  if (tree.grid().projection != grid().projection) return true;
  const double slack = same_rows ? 0.0 : kLatitudeKinds_deg;
  if (node.north_row_deg < change.south - slack || node.south_row_deg > change.north + slack) return false;
  const double half = 0.5 * (change.east - change.west) + 0.5 * (node.east_deg - node.west_deg);
  const double middle = 0.5 * (change.west + change.east);
  const double own = node.lon_center_deg + 0.5 * (node.west_deg + node.east_deg);
  return std::abs(wrapped_deg(middle - own)) <= half;
}

bool Relief::changed_since(const PatchTree& tree, const PatchNode& node, std::size_t since) const {
  for (std::size_t k = since; k < changes_.size(); ++k) {
    if (touches(tree, node, changes_[k])) return true;
  }
  return false;
}

void Relief::refresh_bounds(const PatchTree& tree, PatchNode& node) {
  PatchRelief& relief = node.relief;
  const bool changed = changed_since(tree, node, relief.bounds_seen);
  relief.bounds_seen = changes_.size();
  if (!changed) return;
  const GroundRange range = field_.range_m(tree, node, exaggeration_);
  relief.middle_m = 0.5 * (range.min_m + range.max_m);
  relief.half_m = 0.5 * (range.max_m - range.min_m);
  const BoundingSphere& flat = relief.flat;
  node.sphere.center_m = flat.center_m + relief.middle_m * node.normal;
  // Normals spread: over the patch they differ by its radius over the planet's.
  node.sphere.radius_m =
      flat.radius_m + relief.half_m + std::abs(relief.middle_m) * 2.0 * flat.radius_m / ellipsoid_.b_m();
  // What stands over the ellipsoid is seen from further behind the horizon (paper 2, 2.8).
  const double over = std::max(0.0, range.max_m) / ellipsoid_.b_m();
  const double half_rad = std::min(std::numbers::pi, relief.flat_cone_rad + std::acos(1.0 / (1.0 + over)));
  node.cos_cone = std::cos(half_rad) - 1e-15;
  node.sin_cone = std::sin(half_rad);
}

void Relief::refresh_mesh(const PatchTree& tree, PatchNode& node) {
  PatchRelief& relief = node.relief;
  const bool changed = relief.heights_m.empty() || changed_since(tree, node, relief.mesh_seen);
  relief.mesh_seen = changes_.size();
  if (!changed) return;
  const int n = tree.segments();
  const auto side = static_cast<std::size_t>(n) + 1;
  const double step_rad = 0.5 * std::numbers::pi / (std::ldexp(1.0, node.id.level) * n);
  relief.heights_m.resize(side * side);
  relief.slopes.resize(side * side);
  const auto place = [this](const EcefDir& normal) {
    const auto at = Ellipsoid::lat_lon(normal);
    return std::pair(at, height_m(at.lat, at.lon));
  };
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i) {
      const std::size_t k = static_cast<std::size_t>(j) * side + static_cast<std::size_t>(i);
      const auto [at, height] = place(patch_point(node.id, i, j, n, tree.mapping()));
      relief.heights_m[k] = height;
      const double cosine = std::max(1e-6, std::cos(at.lat.rad()));
      const Angle step = Angle::radians(step_rad);
      const Angle north_lat = Angle::radians(std::min(at.lat.rad() + step_rad, 0.5 * std::numbers::pi));
      const Angle south_lat = Angle::radians(std::max(at.lat.rad() - step_rad, -0.5 * std::numbers::pi));
      const double run_m = 2.0 * step_rad * ellipsoid_.a_m();
      const Angle turn = Angle::radians(std::min(step.rad() / cosine, 1.0));
      relief.slopes[k] = glm::vec2((height_m(at.lat, at.lon + turn) - height_m(at.lat, at.lon - turn)) / run_m,
                                   (height_m(north_lat, at.lon) - height_m(south_lat, at.lon)) / run_m);
    }
  }
  relief.error_m = 0.0;
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const std::size_t k = static_cast<std::size_t>(j) * side + static_cast<std::size_t>(i);
      const double middle = place(patch_point(node.id, 2 * i + 1, 2 * j + 1, 2 * n, tree.mapping())).second;
      const double a = 0.5 * (relief.heights_m[k] + relief.heights_m[k + side + 1]);
      const double b = 0.5 * (relief.heights_m[k + 1] + relief.heights_m[k + side]);
      relief.error_m = std::max({relief.error_m, std::abs(middle - a), std::abs(middle - b)});
    }
  }
  ++relief.made;
}

std::vector<WantedTile> Relief::want(const PatchTree& tree, const std::vector<SelectedPatch>& patches) {
  ++round_;
  std::vector<WantedTile> wanted;
  for (const TileId& id : root_tiles(grid())) want_tile(id, 1e9, wanted);
  const double texel_m = span_m(ellipsoid_, grid());
  for (const SelectedPatch& patch : patches) {
    const PatchNode& node = *patch.node;
    const double asked = std::ceil(std::log2(texel_m / (kPixelsPerHeight * patch.pixel_m)));
    int level = static_cast<int>(std::clamp(asked, double(grid().min_level), double(grid().max_level)));
    const double west = node.lon_center_deg + node.west_deg, east = node.lon_center_deg + node.east_deg;
    while (level > grid().min_level && east - west > kMostColumns * tile_span_deg(grid(), level)) --level;
    const TileXY nw = tile_xy(grid(), level, node.north_row_deg, west);
    const TileXY se = tile_xy(grid(), level, node.south_row_deg, east);
    const std::int64_t around = columns(grid(), level), last_row = rows(grid(), level) - 1;
    const auto first = [](double x) { return static_cast<std::int64_t>(std::floor(x)); };
    for (std::int64_t y = std::max<std::int64_t>(0, first(nw.y)); y <= std::min(last_row, first(se.y)); ++y) {
      for (std::int64_t x = first(nw.x); x <= first(se.x); ++x) {
        want_tile({level, (x % around + around) % around, y}, -level + 0.5, wanted);
      }
    }
  }
  (void)tree;
  return wanted;
}

void Relief::want_tile(const TileId& id, double priority, std::vector<WantedTile>& wanted) {
  if (!exists(grid(), id) || lacking_.contains(id)) return;
  std::uint64_t& last = last_wanted_[id];
  const bool first = last != round_;
  last = round_;
  if (first && !field_.has(id)) wanted.push_back({id, priority});
}

void Relief::keep_to_budget() {
  if (field_.size() <= most_tiles_) return;
  std::vector<std::pair<std::uint64_t, TileId>> old;
  for (const auto& [id, round] : last_wanted_) {
    if (round + 1 < round_ && id.level > grid().min_level && field_.has(id)) old.emplace_back(round, id);
  }
  std::sort(old.begin(), old.end());
  for (const auto& [round, id] : old) {
    if (field_.size() <= most_tiles_ * 7 / 8) return;
    field_.remove(id);
    last_wanted_.erase(id);
    note_change(id);
  }
}

}  // namespace terrella
