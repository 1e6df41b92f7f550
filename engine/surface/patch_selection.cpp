#include "surface/patch_selection.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <optional>

#include "geo/longitudes.h"
#include "geo/scaled_space.h"
#include "surface/relief.h"

namespace terrella {
namespace {

// A bent patch stands with coordinates per fragment only if it is not much larger than the band: each of its pixels
// pays for them.
constexpr double kMostOverBand = 4.0;
// One that reaches this far is split where it is large on the screen: a fragment of the polar program costs more than
// a twelfth of a triangle.
constexpr double kFarOverBand = 2.5;
constexpr double kPixelsATriangle = 12.0;
// How far the ground may lie from the mesh: with what the heights' own level leaves out, under a pixel.
constexpr double kMostReliefError_px = 0.5;
// Texels this many times as large as a pixel show what squeezing took from them.
constexpr double kMagnified = 2.0;
// Vertices closer than this would follow heights that no pixel shows, and that are 1 to 2 pixels apart themselves.
constexpr double kLeastSegment_px = 1.0;
// Deeper, a patch's vertices are centimetres apart.
constexpr int kMostReliefLevel = 20;
// Room for the patches of most views.
constexpr std::size_t kUsualPatches = 512;

class Selector {
 public:
  Selector(const PatchTree& tree, TreeGrowth& growth, const View& view, const PatchSelectionOptions& options,
           PatchSelection& out, std::span<const FurtherImagery> further)
      : tree_(tree),
        relief_(tree.relief()),
        meshes_left_(relief_ == nullptr ? 0 : relief_->meshes_left()),
        growth_(growth),
        view_(view),
        options_(options),
        plan_(out),
        out_(out.patches),
        further_(further),
        planes_(view_planes(view)),
        imagery_{
            .tree = &tree, .texels_per_pixel = options.texels_per_pixel, .max_tile_level = options.max_tile_level} {
    const Ellipsoid& e = tree.ellipsoid();
    find_horizon(e);
    // No surface point is nearer than the height; 1 % off for the mesh, which sags.
    if (relief_ == nullptr) least_distance_m_ = 0.99 * std::abs(e.to_geodetic(view.eye).height_m);
    radians_per_pixel_ = 1.0 / view.pixels_per_radian();
    // Off the axis a perspective picture magnifies: the corner of the picture is where a metre is most pixels.
    const double corner = view.tan_half_fov_y * std::hypot(1.0, view.aspect());
    error_scale_px_ = view.pixels_per_radian() * std::hypot(1.0, corner);
    band_rad_ = options.band * std::numbers::pi;
  }

  void visit(const PatchNode& node, bool inside) {
    if (behind_horizon(node)) return;
    if (!inside) {
      const int side = classify(planes_, view_, node.sphere);
      if (side < 0) return;
      inside = side > 0;
    }
    SelectedPatch patch = assess(imagery_, node, node);
    if (needs_split(node, patch) || further_needs_split(node)) {
      split(node, inside);
    } else {
      emit(node, patch, inside);
    }
  }

  // Splits leaves until no neighbour in view is more than one level apart, then notes the coarse sides.
  void balance() {
    for (bool changed = true; changed;) {
      changed = false;
      for (std::size_t k = 0; k < out_.size(); ++k) changed = split_coarse_neighbours(*out_[k].node) || changed;
      std::erase_if(out_, [this](const SelectedPatch& p) { return !growth_.is_leaf(*p.node); });
    }
    for (SelectedPatch& patch : out_) patch.coarse_sides = coarse_sides(*patch.node);
  }

  // The selected patches again, by each further grid.
  void select_further() {
    for (const FurtherImagery& imagery : further_) {
      imagery.out->clear();
      for (const SelectedPatch& patch : out_) {
        const PatchNode* node = node_of(imagery, *patch.node);
        if (node == nullptr || wanted_level(imagery, *node, *patch.node) < imagery.least_level) continue;
        SelectedPatch also = assess(imagery, *node, *patch.node);
        also.in_band = bent(*node, *patch.node) && in_band(*node);
        also.coarse_sides = patch.coarse_sides;
        also.cut_by_view = patch.cut_by_view;
        also.surface = patch.node;
        imagery.out->push_back(also);
      }
    }
  }

 private:
  // Scaled space: a surface point q sees the eye iff q · eye ≥ 1, that is if it lies within the horizon's angle of the
  // eye's direction. Hidden is a cone of directions that lies further from it by its half angle.
  [[nodiscard]] bool behind_horizon(const PatchNode& node) const {
    if (!has_horizon_) return false;
    const double c = glm::dot(node.cone_axis, eye_direction_);
    // A cone and a horizon that reach around the planet together hide nothing.
    if (node.sin_cone * cos_horizon_ + node.cos_cone * sin_horizon_ < 0.0) return false;
    return c < node.cos_cone * cos_horizon_ - node.sin_cone * sin_horizon_;
  }

  // The eyes of one selection lie in a ball: the highest of them sees furthest, and the ball is wide as seen from the
  // centre.
  void find_horizon(const Ellipsoid& e) {
    const glm::dvec3 eye = view_.eye.xyz_m / semi_axes_m(e);
    const double length = glm::length(eye), spread = view_.eye_spread_m / e.b_m();
    const std::optional<double> angle = horizon_rad(length, spread, options_.inner_sphere_m / e.a_m());
    has_horizon_ = angle && options_.horizon_culling != HorizonCulling::off;
    if (!has_horizon_) return;
    eye_direction_ = eye / length;
    cos_horizon_ = std::cos(*angle);
    sin_horizon_ = std::sin(*angle);
  }

  // How far around the centre, from the eye's direction, the surface can be seen; nothing if nothing hides any of it.
  [[nodiscard]] std::optional<double> horizon_rad(double length, double spread, double inner) const {
    const double drift = std::asin(std::min(1.0, spread / length));
    if (length - spread > 1.0) return std::acos(1.0 / (length + spread)) + drift;
    if (length - spread <= inner || length <= 0.0) return std::nullopt;
    const double half = 0.5 * std::numbers::pi + drift;
    // A sight line grazes the inner sphere: so far from the eye's direction it touches, as far again it comes out.
    const double behind_inner = std::acos(inner / std::min(1.0, length + spread)) + std::acos(inner) + drift;
    if (options_.horizon_culling == HorizonCulling::on) return inner > 0.0 ? std::min(half, behind_inner) : half;
    if (inner > 0.0 && behind_inner < std::numbers::pi) return behind_inner;
    return std::nullopt;
  }

  // Heights stand on a patch as a column does. In a sphere around a high one the eye would be where it stands beside
  // it, and every patch around would be as near as can be.
  struct Column {
    double radius_m;   ///< what lies in the patch lies no further from the axis
    double to_axis_m;  ///< from the eye that is nearer
    double nearest_m;  ///< from that eye, of what lies in the patch
  };
  [[nodiscard]] Column column(const PatchNode& node) const {
    const double half_m = node.relief.half_m;
    const auto to_axis_m = [&](const glm::dvec3& eye) {
      const glm::dvec3 from_center = eye - node.sphere.center_m;
      const double along = std::clamp(glm::dot(from_center, node.normal), -half_m, half_m);
      return glm::length(from_center - along * node.normal);
    };
    const glm::dvec3 beside = view_.eye_spread_m * view_.right;
    // Normals spread, and the column's ends with them.
    const double spread_m = half_m * 2.0 * node.relief.flat.radius_m / tree_.ellipsoid().b_m();
    Column c{node.sphere.radius_m - half_m + spread_m, to_axis_m(view_.eye.xyz_m - beside), 0.0};
    if (view_.eye_spread_m != 0.0) c.to_axis_m = std::min(c.to_axis_m, to_axis_m(view_.eye.xyz_m + beside));
    c.nearest_m = std::max({c.to_axis_m - c.radius_m, 1e-3 * c.radius_m, least_distance_m_});
    return c;
  }

  [[nodiscard]] double nearest_m(const PatchNode& node) const { return column(node).nearest_m; }

  // A pixel on the ground at the patch's centre: its short side, across the line of sight, and its extents east and
  // north.
  struct PixelOnGround {
    double short_m, east_m, north_m;
  };
  [[nodiscard]] PixelOnGround pixel_on_ground(const PatchNode& node, const PatchNode& body, double nearest_m) const {
    const glm::dvec3 to_eye = view_.eye.xyz_m - body.sphere.center_m;
    const double distance = std::max(glm::length(to_eye), 1e-9);
    const double up = glm::dot(to_eye, node.normal) / distance;
    const double east = (node.frame.x * to_eye.y - node.frame.y * to_eye.x) / distance;
    const double flat = std::max(1e-9, std::sqrt(std::max(0.0, 1.0 - up * up)));
    const double sine = std::min(1.0, std::abs(east) / flat), cosine = std::sqrt(1.0 - sine * sine);
    const double across = distance * radians_per_pixel_, along = across / std::clamp(std::abs(up), 0.05, 1.0);
    return {nearest_m * radians_per_pixel_ / std::sqrt(std::clamp(std::abs(up), 0.05, 1.0)),
            std::sqrt(along * along * (sine * sine) + across * across * (cosine * cosine)),
            std::sqrt(along * along * (cosine * cosine) + across * across * (sine * sine))};
  }

  [[nodiscard]] PixelOnGround nearest_pixel(const PatchNode& node, const PatchNode& body) const {
    const Column c = column(body);
    return pixel_on_ground(node, body, std::max(c.to_axis_m - 0.7 * c.radius_m, c.nearest_m));
  }

  [[nodiscard]] double texel0_m(const FurtherImagery& imagery, const PatchNode& node) const {
    const TileGrid& grid = imagery.tree->grid();
    return tree_.ellipsoid().a_m() * (std::numbers::pi / 180.0) * grid.root_span_deg / grid.tile_px * node.row_stretch;
  }

  [[nodiscard]] int wanted_level(const FurtherImagery& imagery, const PatchNode& node, const PatchNode& body) const {
    return wanted_level(texel0_m(imagery, node) * imagery.texels_per_pixel, nearest_pixel(node, body));
  }
  [[nodiscard]] static int wanted_level(double texel0_m, const PixelOnGround& pixel) {
    const double level = std::ceil(std::log2(texel0_m / pixel.short_m) - 0.02);
    return static_cast<int>(std::clamp(level, -64.0, 64.0));
  }

  [[nodiscard]] static int finest_level(const FurtherImagery& imagery) {
    const TileGrid& grid = imagery.tree->grid();
    return std::clamp(imagery.max_tile_level, grid.min_level, grid.max_level);
  }

  [[nodiscard]] SelectedPatch assess(const FurtherImagery& imagery, const PatchNode& node,
                                     const PatchNode& body) const {
    SelectedPatch patch;
    patch.node = &node;
    const PixelOnGround pixel = nearest_pixel(node, body);
    const double texel0_m = this->texel0_m(imagery, node);
    const bool near_pole = node.min_colatitude_rad < band_rad_;
    const TileGrid& grid = imagery.tree->grid();
    const int finest = finest_level(imagery);
    patch.tile_level = std::clamp(wanted_level(texel0_m * imagery.texels_per_pixel, pixel), grid.min_level, finest);
    patch.pixel_m = pixel.short_m;
    const double span_deg = std::max(node.east_deg - node.west_deg, 0.0);
    for (;; --patch.tile_level) {
      const double columns = span_deg / tile_span_deg(grid, patch.tile_level);
      const double texel_m = std::ldexp(texel0_m, -patch.tile_level);
      // Of the finest tiles squeezed ones have less detail than the picture. Magnified it would be missed.
      patch.squeezed =
          patch.tile_level < finest || texel_m < kMagnified * pixel.short_m || columns > options_.max_polar_columns;
      patch.squeeze = patch.squeezed ? imagery.tree->window_squeeze(node, patch.tile_level) : 0;
      patch.footprint_texels = footprint_m(node, pixel, patch.squeeze) / texel_m;
      // Finer, a pixel would be longer than the taps and the gutter reach, or a pole's window too wide.
      const bool fits = near_pole ? std::ldexp(columns, -patch.squeeze) <= options_.max_polar_columns
                                  : patch.footprint_texels <= options_.max_footprint_texels;
      if (fits || patch.tile_level == grid.min_level) return patch;
    }
  }

  // The longer side of a pixel as if texels were as long along the parallel as along the meridian: where they are
  // narrow, and not squeezed, it is long.
  [[nodiscard]] static double footprint_m(const PatchNode& node, const PixelOnGround& pixel, int squeeze) {
    const double narrow = std::ldexp(std::sin(std::max(node.min_colatitude_rad, 1e-3)), squeeze);
    return std::max(pixel.east_m / std::min(narrow, 1.0), pixel.north_m);
  }

  [[nodiscard]] bool needs_split(const PatchNode& node, SelectedPatch& patch) {
    if (node.id.level < 1) return true;
    if (node.id.level >= kMaxPatchLevel) return false;
    if (node.geometric_error_m * error_scale_px_ / nearest_m(node) > options_.max_error_px) return true;
    return imagery_needs_split(imagery_, node, node, patch) || follows_ground_badly(node, patch);
  }

  [[nodiscard]] bool imagery_needs_split(const FurtherImagery& imagery, const PatchNode& node, const PatchNode& body,
                                         SelectedPatch& patch) const {
    const bool is_bent = bent(node, body);
    patch.in_band = is_bent && in_band(node);
    if (is_bent && (!patch.in_band || reaches_far_over_the_band(body))) return true;
    return window_too_wide(imagery, node, patch) || reaches_to_the_eye(imagery, body, patch);
  }

  // Interpolated texture coordinates are off by more than they may be.
  [[nodiscard]] bool bent(const PatchNode& node, const PatchNode& body) const {
    const double px = error_scale_px_ / nearest_m(body);
    return node.geometric_error_m * node.texture_error_factor * px > options_.max_error_px;
  }
  [[nodiscard]] bool in_band(const PatchNode& node) const { return node.min_colatitude_rad < band_rad_; }

  [[nodiscard]] bool further_needs_split(const PatchNode& node) const {
    if (node.id.level >= kMaxPatchLevel) return false;
    for (const FurtherImagery& imagery : further_) {
      const PatchNode* own = node_of(imagery, node);
      if (own == nullptr || wanted_level(imagery, *own, node) < imagery.least_level) continue;
      SelectedPatch patch = assess(imagery, *own, node);
      if (imagery_needs_split(imagery, *own, node, patch)) return true;
    }
    return false;
  }

  // What further imagery has of a patch; nothing where it is not drawn.
  [[nodiscard]] static const PatchNode* node_of(const FurtherImagery& imagery, const PatchNode& node) {
    const GeoRect& bounds = imagery.tree->grid().bounds;
    const double wide_deg = std::max(0.0, node.east_deg - node.west_deg);
    if (!meets_longitudes(bounds, node.lon_center_deg + node.west_deg, wide_deg)) return nullptr;
    const PatchNode& own = imagery.growth->node(node.id);
    if (own.north_row_deg < bounds.south.deg() || own.south_row_deg > bounds.north.deg()) return nullptr;
    return &own;
  }

  [[nodiscard]] bool reaches_far_over_the_band(const PatchNode& node) const {
    if (node.max_colatitude_rad <= kFarOverBand * band_rad_) return false;
    if (node.max_colatitude_rad > kMostOverBand * band_rad_) return true;
    const glm::dvec3 to_eye = view_.eye.xyz_m - node.sphere.center_m;
    const double distance = std::max(glm::length(to_eye), 1e-9);
    const double across_px = 2.0 * node.sphere.radius_m / (distance * radians_per_pixel_);
    const double pixels = across_px * across_px * std::abs(glm::dot(to_eye, node.normal)) / distance;
    return pixels > kPixelsATriangle * 2.0 * tree_.segments() * tree_.segments();
  }

  // Heights move points along the normal: looked at from above they move less on the screen.
  // Without a mesh nothing is known, and the patch stays as it is until it has one.
  [[nodiscard]] bool follows_ground_badly(const PatchNode& node, const SelectedPatch& patch) {
    if (relief_ == nullptr || node.id.level >= kMostReliefLevel) return false;
    // A child's side is half the patch's, which is √2 of its radius.
    const double child_side_m = node.relief.flat.radius_m * (0.5 * std::numbers::sqrt2);
    if (child_side_m < kLeastSegment_px * tree_.segments() * patch.pixel_m) return false;
    if (want_mesh(node)) ++plan_.undecided;
    if (node.relief.heights_m.empty()) return false;
    const glm::dvec3 to_eye = view_.eye.xyz_m - node.sphere.center_m;
    const double distance = std::max(glm::length(to_eye), 1e-9);
    const double up = glm::dot(to_eye, node.normal) / distance;
    const double sine = std::min(1.0, std::sqrt(std::max(0.0, 1.0 - up * up)) + node.sphere.radius_m / distance);
    const double error_px = node.relief.error_m * sine * error_scale_px_ / nearest_m(node);
    return error_px > kMostReliefError_px && may_split(node);
  }

  // True if heights have changed since the mesh was made, or there is none.
  bool want_mesh(const PatchNode& node) {
    if (!node.relief.heights_m.empty() && node.relief.mesh_seen == relief_->changes_seen()) return false;
    if (!growth_.mark_mesh(node)) return false;
    plan_.meshes.push_back(&node);
    const bool stale = relief_->is_stale(tree_, node);
    if (stale) --meshes_left_;
    return stale;
  }

  // Not, and it is counted, if the children's meshes were never made and the budget is spent: the patch is drawn for a
  // frame more. What must be drawn is made in any case.
  [[nodiscard]] bool may_split(const PatchNode& node) {
    const PatchFamily* family = growth_.known_children(node);
    const auto has_no_mesh = [](const PatchNode* child) { return child->relief.heights_m.empty(); };
    if (meshes_left_ > 0 || (family != nullptr && std::ranges::none_of(*family, has_no_mesh))) return true;
    ++plan_.put_off;
    return false;
  }

  // A patch as large as the eye is near has one tile level for pixels of very different size: the tile level was chosen
  // by its middle, and what lies under the eye would be a blur.
  [[nodiscard]] bool reaches_to_the_eye(const FurtherImagery& imagery, const PatchNode& node,
                                        const SelectedPatch& patch) const {
    // Twice as far as what is nearest, the middle asks for one level less, or the texels where two patches meet would
    // be four pixels wide on one side.
    constexpr double kMostOverNearest = 2.0;
    if (patch.tile_level >= finest_level(imagery)) return false;
    const Column c = column(node);
    return c.to_axis_m > kMostOverNearest * c.nearest_m;
  }

  [[nodiscard]] bool window_too_wide(const FurtherImagery& imagery, const PatchNode& node,
                                     const SelectedPatch& patch) const {
    const double most = options_.max_window * tile_span_deg(imagery.tree->grid(), patch.tile_level);
    if (node.north_row_deg - node.south_row_deg > most) return true;
    const double most_columns = std::ldexp(most, patch.squeeze);
    return node.min_colatitude_rad >= band_rad_ && node.east_deg - node.west_deg > most_columns;
  }

  void split(const PatchNode& node, bool inside) {
    growth_.mark_split(node);
    const PatchFamily family = growth_.children(node);
    for (const PatchNode* child : family) visit(*child, inside);
  }

  void emit(const PatchNode& node, SelectedPatch patch, bool inside) {
    growth_.mark_leaf(node);
    if (relief_ != nullptr) want_mesh(node);
    patch.cut_by_view = !inside || nearly_behind_horizon(node);
    out_.push_back(patch);
  }

  [[nodiscard]] bool nearly_behind_horizon(const PatchNode& node) const {
    if (!has_horizon_) return false;
    const double c = glm::dot(node.cone_axis, eye_direction_);
    const double s = std::sqrt(std::max(0.0, 1.0 - c * c));
    return c * node.cos_cone - s * node.sin_cone < cos_horizon_;
  }

  // The leaf that covers the neighbour across a side, or nullptr where nothing is drawn (culled) or finer patches are.
  // This selection came to a node if it split its parent.
  [[nodiscard]] const PatchNode* leaf_beside(const PatchNode& node, int side) const {
    const PatchNode* other = &growth_.beside(node, static_cast<PatchSide>(side));
    while (other->parent != nullptr && !growth_.is_split(*other->parent)) other = other->parent;
    return growth_.is_leaf(*other) ? other : nullptr;
  }

  bool split_coarse_neighbours(const PatchNode& node) {
    bool changed = false;
    if (!growth_.is_leaf(node)) return false;
    for (int side = 0; side < 4; ++side) {
      const PatchNode* other = leaf_beside(node, side);
      if (other == nullptr || other->id.level >= node.id.level - 1) continue;
      split(*other, false);
      changed = true;
    }
    return changed;
  }

  [[nodiscard]] unsigned coarse_sides(const PatchNode& node) const {
    unsigned mask = 0;
    for (int side = 0; side < 4; ++side) {
      const PatchNode* other = leaf_beside(node, side);
      if (other != nullptr && other->id.level < node.id.level) mask |= 1U << side;
    }
    return mask;
  }

  const PatchTree& tree_;
  const Relief* relief_;
  int meshes_left_;
  TreeGrowth& growth_;
  const View& view_;
  const PatchSelectionOptions& options_;
  PatchSelection& plan_;
  std::vector<SelectedPatch>& out_;
  std::span<const FurtherImagery> further_;
  ViewPlanes planes_;
  FurtherImagery imagery_;  ///< the first tree's
  bool has_horizon_ = false;
  glm::dvec3 eye_direction_{0.0};  ///< in scaled space
  double cos_horizon_ = 1.0, sin_horizon_ = 0.0;
  double least_distance_m_ = 0.0;
  double radians_per_pixel_ = 0.0;
  double error_scale_px_ = 0.0;
  double band_rad_ = 0.0;
};

bool finite(const View& view) {
  const glm::dvec3 all = view.eye.xyz_m + view.right + view.up + view.forward;
  return std::isfinite(all.x + all.y + all.z + view.tan_half_fov_y);
}

}  // namespace

ViewPlanes view_planes(const View& view) {
  const double ty = view.tan_half_fov_y;
  const double tx = ty * view.aspect();
  const glm::dvec3 left = view.forward * (tx - view.shear_x), right = view.forward * (tx + view.shear_x);
  return {{glm::normalize(left + view.right), glm::normalize(right - view.right),
           glm::normalize(view.forward * ty + view.up), glm::normalize(view.forward * ty - view.up)}};
}

int classify(const ViewPlanes& planes, const View& view, const BoundingSphere& sphere) {
  const glm::dvec3 p = sphere.center_m - view.eye.xyz_m;
  int result = 1;
  for (const glm::dvec3& normal : planes.normals) {
    const double d = glm::dot(normal, p);
    if (d < -sphere.radius_m - view.eye_spread_m) return -1;
    if (d < sphere.radius_m + view.eye_spread_m) result = 0;
  }
  return result;
}

PatchSelection plan_patches(const PatchTree& tree, TreeGrowth& growth, const View& view,
                            const PatchSelectionOptions& options, std::span<const FurtherImagery> further) {
  PatchSelection plan;
  for (const FurtherImagery& imagery : further) imagery.out->clear();
  if (!finite(view)) return plan;
  plan.patches.reserve(kUsualPatches);
  growth.clear_selection();
  Selector selector(tree, growth, view, options, plan, further);
  for (int f = 0; f < kCubeFaces; ++f) selector.visit(tree.root(static_cast<CubeFace>(f)), false);
  selector.balance();
  selector.select_further();
  return plan;
}

void select_patches(PatchTree& tree, const View& view, const PatchSelectionOptions& options,
                    std::vector<SelectedPatch>& out) {
  tree.refresh_bounds();
  for (bool decided = false; !decided;) {
    TreeGrowth growth(tree, tree.relief());
    PatchSelection plan = plan_patches(tree, growth, view, options);
    tree.adopt(growth);
    tree.make_meshes(plan.meshes);
    decided = plan.undecided == 0;
    out = std::move(plan.patches);
  }
}

}  // namespace terrella
