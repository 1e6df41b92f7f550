#include "surface/patch_tree.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <utility>

#include "surface/tree_growth.h"

namespace terrella {
namespace {

// Longitude has no value at a pole: such a vertex takes no part in a patch's extent.
bool on_axis(const EcefDir& n) { return n.xyz.x == 0.0 && n.xyz.y == 0.0; }

double colatitude(const EcefDir& n) { return std::atan2(std::hypot(n.xyz.x, n.xyz.y), std::abs(n.xyz.z)); }

// The points of the patch's border lattice. A patch has its pole, if any, at a corner, so the extremes of
// latitude and longitude of all its vertices lie on the border.
template <class Visit>
void visit_border(const PatchId& id, int n, CubeMapping mapping, Visit visit) {
  for (int k = 0; k < n; ++k) {
    visit(patch_point(id, k, 0, n, mapping));
    visit(patch_point(id, n, k, n, mapping));
    visit(patch_point(id, n - k, n, n, mapping));
    visit(patch_point(id, 0, n - k, n, mapping));
  }
}

// Rows of an equal-area grid are taller on the ground towards the poles: d(latitude)/d(row latitude), at least.
double least_row_stretch(const TileGrid& grid, double min_abs_lat_rad) {
  if (grid.projection == Projection::equirectangular) return 1.0;
  return (2.0 / std::numbers::pi) / std::max(1e-3, std::cos(min_abs_lat_rad));
}

void measure_extent(PatchNode& node, const Ellipsoid& ellipsoid, const TileGrid& grid, int n, CubeMapping mapping) {
  const glm::dvec3 scale(1.0 / ellipsoid.a_m(), 1.0 / ellipsoid.a_m(), 1.0 / ellipsoid.b_m());
  node.cone_axis = glm::normalize(node.sphere.center_m * scale);
  node.west_deg = node.south_row_deg = 1e9;
  node.east_deg = node.north_row_deg = -1e9;
  node.min_colatitude_rad = 1e9;
  double radius2 = 0.0;
  double cos_cone = 1.0;
  visit_border(node.id, n, mapping, [&](const EcefDir& normal) {
    const glm::dvec3 p = ellipsoid.position(normal).xyz_m;
    const glm::dvec3 d = p - node.sphere.center_m;
    radius2 = std::max(radius2, glm::dot(d, d));
    cos_cone = std::min(cos_cone, glm::dot(node.cone_axis, glm::normalize(p * scale)));
    const double row = row_latitude_deg(grid, ellipsoid, normal);
    node.south_row_deg = std::min(node.south_row_deg, row);
    node.north_row_deg = std::max(node.north_row_deg, row);
    node.min_colatitude_rad = std::min(node.min_colatitude_rad, colatitude(normal));
    node.max_colatitude_rad = std::max(node.max_colatitude_rad, colatitude(normal));
    if (on_axis(normal)) return;
    const double lon = wrapped_deg(Ellipsoid::lat_lon(normal).lon.deg() - node.lon_center_deg);
    node.west_deg = std::min(node.west_deg, lon);
    node.east_deg = std::max(node.east_deg, lon);
  });
  // A hair wider than the vertices, for rounding: the spheres only ever cull.
  node.sphere.radius_m =
      std::sqrt(radius2) * (1.0 + 1e-9) + 1e-9 * ellipsoid.a_m() * std::numeric_limits<float>::epsilon();
  node.cos_cone = std::clamp(cos_cone, -1.0, 1.0) - 1e-15;
  node.sin_cone = std::sqrt(std::max(0.0, 1.0 - node.cos_cone * node.cos_cone));
}

}  // namespace

double wrapped_deg(double deg) { return deg - 360.0 * std::round(deg / 360.0); }

glm::dvec3 row_direction(const TileGrid& grid, const Ellipsoid& ellipsoid, const glm::dvec3& normal) {
  return {normal.x, normal.y, grid.latitude == LatitudeKind::centric ? normal.z * ellipsoid.one_minus_e2() : normal.z};
}

PatchTree::PatchTree(const Ellipsoid& ellipsoid, const TileGrid& grid, int segments, CubeMapping mapping)
    : ellipsoid_(ellipsoid), grid_(grid), segments_(segments), mapping_(mapping) {
  for (int f = 0; f < kCubeFaces; ++f) {
    PatchNode& node = roots_[static_cast<std::size_t>(f)];
    node.index = static_cast<std::uint32_t>(f);
    node.serial = ++serial_;
    measure(node, PatchId{static_cast<CubeFace>(f), 0, 0, 0});
  }
}

void PatchTree::measure(PatchNode& node, const PatchId& id) const {
  node.id = id;
  const EcefDir center = patch_point(id, 1, 1, 2, mapping_);
  node.normal = center.xyz;
  node.sphere.center_m = ellipsoid_.position(center).xyz_m;
  node.lon_center_deg = Ellipsoid::lat_lon(center).lon.deg();
  node.row_center_deg = row_latitude_deg(grid_, ellipsoid_, center);
  const glm::dvec3 m = glm::normalize(row_direction(grid_, ellipsoid_, center.xyz));
  const double equatorial = std::hypot(m.x, m.y);
  node.frame = equatorial > 0.0 ? glm::dvec4(m.x / equatorial, m.y / equatorial, equatorial, m.z)
                                : glm::dvec4(1.0, 0.0, 0.0, m.z);
  measure_extent(node, ellipsoid_, grid_, segments_, mapping_);
  node.relief.flat = node.sphere;
  node.relief.flat_cone_rad = std::acos(node.cos_cone);

  // A segment spans at most π/2 / (2^level n), under the plain mapping 4/π as much; over the diagonal of a quad the
  // chord sags (√2 Δ)²/8 of the radius of curvature, which is at most a²/b.
  const double face_rad = mapping_ == CubeMapping::plain ? 2.0 : 0.5 * std::numbers::pi;
  const double segment = face_rad / (std::ldexp(1.0, id.level) * segments_);
  node.geometric_error_m = ellipsoid_.a_m() * (ellipsoid_.a_m() / ellipsoid_.b_m()) * segment * segment * 0.25;
  // Along a course ds = (a east, b north), d²(longitude)/ds² · cos(latitude) = 2 a b tan(latitude) and d²(latitude)/ds²
  // = -a² tan(latitude), for equal-area rows -tan(latitude): together at most 2/√3, or √2, times the tangent. The
  // coordinate, interpolated along the chord, lags by that times the same Δ²/4.
  const double colat = std::max(node.min_colatitude_rad, segment);
  const double worst_course =
      grid_.projection == Projection::equal_area ? std::numbers::sqrt2 : 2.0 * std::numbers::inv_sqrt3;
  node.texture_error_factor = std::max(1.0, worst_course / std::tan(std::min(colat, 1.5)));
  node.row_stretch = least_row_stretch(grid_, 0.5 * std::numbers::pi - node.max_colatitude_rad);
}

void PatchTree::touch(PatchNode& node) {
  if (std::exchange(node.children_used, frame_) != frame_) used_ += 4;
}

void PatchTree::ensure_children(PatchNode& node) {
  TreeGrowth growth(*this);
  static_cast<void>(growth.children(node));
  adopt(growth);
}

std::size_t PatchTree::place_of_new_family(std::size_t k) const {
  const std::size_t family = k < free_.size() ? free_[free_.size() - 1 - k] : families_.size() + k - free_.size();
  return roots_.size() + 4 * family;
}

void PatchTree::adopt(TreeGrowth& growth) {
  for (std::size_t k = 0; k < growth.made_.size(); ++k) {
    PatchFamily& children = own(*growth.parents_[k]).children;
    for (std::size_t n = 0; n < 4; ++n) children[n] = &(*growth.made_[k])[n];
    const std::size_t family = free_.empty() ? families_.size() : free_.back();
    if (free_.empty()) {
      families_.emplace_back();
    } else {
      free_.pop_back();
    }
    families_[family] = std::move(growth.made_[k]);
  }
  serial_ += 4 * growth.made_.size();
  for (const NodeRef& node : growth.used_) touch(own(*node));
  for (const TreeGrowth::Beside& b : growth.beside_) {
    own(*b.node).beside[static_cast<std::size_t>(b.side)] = &own(*b.found);
  }
  for (auto& [node, window] : growth.windows_) own(*node).window = std::move(window);
  for (TreeGrowth::Lattice& l : growth.lattices_) {
    TileWindow* window = own(*l.node).window.get();
    if (window == l.window) window->cells[l.cell].lattice = std::move(l.lattice);
  }
  growth.begin(*this);
}

// The bounds' count stays: a tree that comes to be the first one works out its cones then.
void PatchTree::copy_relief(const PatchNode& from, const PatchNode& to) {
  PatchNode& node = own(to);
  node.sphere = from.sphere;
  node.relief.middle_m = from.relief.middle_m;
  node.relief.half_m = from.relief.half_m;
  if (node.relief.made == from.relief.made) return;
  const std::uint64_t bounds_seen = node.relief.bounds_seen;
  node.relief = from.relief;
  node.relief.bounds_seen = bounds_seen;
}

void PatchTree::end_frame(std::size_t many) {
  const std::size_t most = std::max(many, 3 * used_);
  // One drop removes more nodes than needed, so that few frames drop any.
  if (size() > most) drop_oldest(size() - most * 3 / 4);
  used_ = 0;
  ++frame_;
}

// A frame that uses a node uses its parent. So the nodes under a dropped node are as old, and are dropped too.
void PatchTree::drop_oldest(std::size_t nodes) {
  const auto is_old = [this](const PatchNode& node) {
    return node.children[0] != nullptr && node.children_used < frame_;
  };
  std::vector<std::uint64_t> ages;
  visit_nodes([&](const PatchNode& node) {
    if (is_old(node)) ages.push_back(node.children_used);
  });
  if (ages.empty()) return;
  const auto last = ages.begin() + static_cast<std::ptrdiff_t>(std::min(nodes / 4, ages.size() - 1));
  std::nth_element(ages.begin(), last, ages.end());
  const std::size_t kept = free_.size();
  visit_nodes([&](PatchNode& node) {
    if (!is_old(node) || node.children_used > *last) return;
    free_.push_back((node.children[0]->index - roots_.size()) / 4);
    for (PatchNode* child : node.children) child->serial = 0;
    node.children = {};
  });
  visit_nodes([](PatchNode& node) {
    for (PatchNode*& beside : node.beside) {
      if (beside != nullptr && beside->serial == 0) beside = nullptr;
    }
  });
  for (std::size_t k = kept; k < free_.size(); ++k) families_[free_[k]].reset();
}

}  // namespace terrella
