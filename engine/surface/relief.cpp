#include "surface/relief.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "base/hash_mix.h"
#include "tiles/tile_range.h"

namespace terrella {
namespace {

// Pixels per requested height. The ground between two heights is a plane anyhow.
constexpr double kPixelsPerHeight = 2.0;
// A patch takes a coarser level if it is wider than this many tiles.
constexpr std::int64_t kMostColumns = 6;
// Largest difference between the kinds of latitude that two grids may count, for f = 0.1, degrees.
constexpr double kLatitudeKinds_deg = 7.0;
// Number of remembered changes. A patch that was last looked at before them counts as changed.
constexpr std::size_t kMostChanges = 1024;

double span_m(const Ellipsoid& e, const TileGrid& grid) {
  return e.a_m() * (std::numbers::pi / 180.0) * grid.root_span_deg / grid.tile_px;
}

}  // namespace

Relief::Relief(const Ellipsoid& ellipsoid, const TileGrid& grid, double exaggeration, std::size_t budget_bytes)
    : ellipsoid_(ellipsoid),
      field_(ellipsoid, grid),
      roots_(root_tiles(grid)),
      exaggeration_(exaggeration),
      tile_bytes_(sizeof(float) * static_cast<std::size_t>(grid.tile_px) * static_cast<std::size_t>(grid.tile_px)),
      most_tiles_(std::max<std::size_t>(64, budget_bytes / tile_bytes_)) {}

void Relief::set_exaggeration(double exaggeration) {
  exaggeration_ = exaggeration;
  note_change({.west = -180.0, .east = 180.0, .south = -90.0, .north = 90.0});
}

void Relief::add(HeightTile tile) {
  range_ = {.min_m = std::min(range_.min_m, double(tile.min_m)), .max_m = std::max(range_.max_m, double(tile.max_m))};
  note_change(change_of(tile.id));
  TileResidency::Entry& entry = tiles_.entry(tile.id);
  entry.state = TileState::resident;
  stamp(entry);
  field_.add(std::move(tile));
  keep_to_budget();
}

// A tile's heights reach half a pixel over its border, into its neighbours.
Relief::Change Relief::change_of(const TileId& id) const {
  const TileBounds b = tile_bounds(grid(), id);
  const double pixel_deg = (b.east_deg - b.west_deg) / grid().tile_px;
  return {.west = b.west_deg - pixel_deg,
          .east = b.east_deg + pixel_deg,
          .south = b.south_deg - pixel_deg,
          .north = b.north_deg + pixel_deg};
}

void Relief::note_change(const Change& change) {
  changes_.push_back(change);
  if (changes_.size() <= kMostChanges) return;
  changes_.pop_front();
  ++changes_forgotten_;
}

int Relief::touched(const PatchTree& tree, const TileId& id, const std::vector<SelectedPatch>& patches) const {
  const Change change = change_of(id);
  return static_cast<int>(
      std::ranges::count_if(patches, [&](const SelectedPatch& patch) { return touches(tree, *patch.node, change); }));
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

bool Relief::changed_since(const PatchTree& tree, const PatchNode& node, std::uint64_t since) const {
  if (since < changes_forgotten_) return true;
  for (std::uint64_t k = since - changes_forgotten_; k < changes_.size(); ++k) {
    if (touches(tree, node, changes_[k])) return true;
  }
  return false;
}

bool Relief::changed_since(const TileId& id, std::uint64_t since) const {
  if (since < changes_forgotten_) return true;
  const Change tile = change_of(ancestor(id, std::max(0, id.level - grid().max_level)));
  const double half_deg = 0.5 * (tile.east - tile.west), middle_deg = 0.5 * (tile.west + tile.east);
  // Slopes beside a pole take heights from beyond it, and from columns more than a tile away: see columns_apart() in
  // height_slopes.cpp.
  const bool at_pole = std::max(tile.north, -tile.south) > 90.0 - Angle::radians(1.0 / grid().tile_px).deg();
  return std::any_of(changes_.begin() + static_cast<std::ptrdiff_t>(since - changes_forgotten_), changes_.end(),
                     [&](const Change& change) {
                       const double apart_deg = wrapped_deg(0.5 * (change.west + change.east) - middle_deg);
                       return tile.north >= change.south && tile.south <= change.north &&
                              (at_pole || std::abs(apart_deg) <= half_deg + 0.5 * (change.east - change.west));
                     });
}

bool Relief::changed_since(const Geodetic& place, std::uint64_t since) const {
  if (since < changes_forgotten_) return true;
  const double row_deg = field_.row_deg(place.lat), lon_deg = place.lon.deg();
  return std::any_of(changes_.begin() + static_cast<std::ptrdiff_t>(since - changes_forgotten_), changes_.end(),
                     [&](const Change& change) {
                       const double apart_deg = wrapped_deg(0.5 * (change.west + change.east) - lon_deg);
                       return row_deg >= change.south && row_deg <= change.north &&
                              std::abs(apart_deg) <= 0.5 * (change.east - change.west);
                     });
}

// New nodes are up to date (TreeGrowth), so the roots tell of all nodes.
void Relief::refresh_bounds(PatchTree& tree) const {
  if (tree.root(CubeFace::pos_x).relief.bounds_seen == changes_seen()) return;
  tree.visit_nodes([&](PatchNode& node) { refresh_bounds(tree, node); });
}

void Relief::refresh_bounds(const PatchTree& tree, PatchNode& node) const {
  PatchRelief& relief = node.relief;
  const bool changed = changed_since(tree, node, relief.bounds_seen);
  relief.bounds_seen = changes_seen();
  if (!changed) return;
  const GroundRange range = field_.range_m(tree, node, exaggeration_);
  relief.middle_m = 0.5 * (range.min_m + range.max_m);
  relief.half_m = 0.5 * (range.max_m - range.min_m);
  const BoundingSphere& flat = relief.flat;
  node.sphere.center_m = flat.center_m + relief.middle_m * node.normal;
  // Normals spread: over the patch they differ by its radius over the planet's.
  node.sphere.radius_m =
      flat.radius_m + relief.half_m + std::abs(relief.middle_m) * 2.0 * flat.radius_m / ellipsoid_.b_m();
  // Ground over the ellipsoid is visible from further behind the horizon (paper 2, 2.8).
  const double over = std::max(0.0, range.max_m) / ellipsoid_.b_m();
  const double half_rad = std::min(std::numbers::pi, relief.flat_cone_rad + std::acos(1.0 / (1.0 + over)));
  node.cos_cone = std::cos(half_rad) - 1e-15;
  node.sin_cone = std::sin(half_rad);
}

int Relief::make_meshes(PatchTree& tree, const std::vector<NodeRef>& nodes) const {
  return static_cast<int>(
      std::ranges::count_if(nodes, [&](const NodeRef& node) { return refresh_mesh(tree, PatchTree::own(*node)); }));
}

bool Relief::refresh_mesh(const PatchTree& tree, PatchNode& node) const {
  PatchRelief& relief = node.relief;
  const bool changed = is_stale(tree, node);
  relief.mesh_seen = changes_seen();
  if (!changed) return false;
  measure_vertices(tree, node);
  measure_error(tree, node);
  relief.made =
      name_hash({reinterpret_cast<const char*>(relief.heights_m.data()), relief.heights_m.size() * sizeof(double)});
  return true;
}

void Relief::measure_vertices(const PatchTree& tree, PatchNode& node) const {
  const int n = tree.segments();
  PatchRelief& relief = node.relief;
  relief.heights_m.clear();
  const auto side = static_cast<std::size_t>(n) + 1;
  relief.heights_m.reserve(side * side);
  HeightField::Cursor ground(field_);
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i) {
      const Geodetic at = Ellipsoid::lat_lon(patch_point(node.id, i, j, n, tree.mapping()));
      relief.heights_m.push_back(exaggeration_ * ground.height_at_row_m(field_.row_deg(at.lat), at.lon.deg()));
    }
  }
}

// A mesh strays furthest in the middle of its quads.
void Relief::measure_error(const PatchTree& tree, PatchNode& node) const {
  const int n = tree.segments();
  const auto side = static_cast<std::size_t>(n) + 1;
  PatchRelief& relief = node.relief;
  relief.error_m = 0.0;
  HeightField::Cursor ground(field_);
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const std::size_t k = static_cast<std::size_t>(j) * side + static_cast<std::size_t>(i);
      const Geodetic at = Ellipsoid::lat_lon(patch_point(node.id, 2 * i + 1, 2 * j + 1, 2 * n, tree.mapping()));
      const double middle = exaggeration_ * ground.height_at_row_m(field_.row_deg(at.lat), at.lon.deg());
      const double a = 0.5 * (relief.heights_m[k] + relief.heights_m[k + side + 1]);
      const double b = 0.5 * (relief.heights_m[k + 1] + relief.heights_m[k + side]);
      relief.error_m = std::max({relief.error_m, std::abs(middle - a), std::abs(middle - b)});
    }
  }
}

std::vector<WantedTile> Relief::want(const std::vector<SelectedPatch>& patches) {
  ++round_;
  tiles_.end_frame(round_, grid().min_level);
  std::vector<WantedTile> wanted;
  for (const TileId& id : roots_) want_tile(id, 1e9, wanted);
  want_too(patches, wanted);
  return wanted;
}

void Relief::want_too(const std::vector<SelectedPatch>& patches, std::vector<WantedTile>& wanted) {
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
}

void Relief::want_tile(const TileId& id, double priority, std::vector<WantedTile>& wanted) {
  if (!exists(grid(), id)) return;
  TileResidency::Entry& entry = tiles_.entry(id);
  if (entry.last_seen == round_) return;
  stamp(entry);
  if (entry.state == TileState::unknown) wanted.push_back({id, priority});
}

void Relief::stamp(TileResidency::Entry& entry) const {
  entry.last_seen = entry.last_needed = entry.last_drawn = round_;
}

void Relief::keep_to_budget() {
  while (field_.size() > most_tiles_) {
    const std::optional<TileId> oldest = tiles_.to_evict(round_, grid().min_level);
    if (!oldest) return;
    field_.remove(*oldest);
    tiles_.erase(*oldest);
    note_change(change_of(*oldest));
  }
}

}  // namespace terrella
