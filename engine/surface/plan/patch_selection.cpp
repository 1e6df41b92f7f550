#include "surface/plan/patch_selection.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "surface/plan/horizon.h"
#include "surface/plan/imagery_fit.h"
#include "surface/relief.h"
#include "surface/view_planes.h"

namespace terrella {
namespace {

// Most pixels between the ground and the mesh. With the error of the heights' own level it stays under a pixel.
constexpr double kMostReliefError_px = 0.5;
// Vertices closer than this would follow heights that no pixel shows: heights are 1 to 2 pixels apart themselves.
constexpr double kLeastSegment_px = 1.0;
// Vertices of deeper patches are centimetres apart.
constexpr int kMostReliefLevel = 20;

class Selector {
 public:
  Selector(const PatchTree& tree, TreeGrowth& growth, const View& view, const PatchSelectionOptions& options,
           PatchSelection& out, std::span<const FurtherImagery> further)
      : tree_(tree),
        relief_(options.relief),
        meshes_left_(options.mesh_budget),
        growth_(growth),
        view_(view),
        options_(options),
        plan_(out),
        out_(out.patches),
        planes_(view_planes(view)),
        horizon_(tree.ellipsoid(), view, options.horizon_culling, options.inner_sphere_m),
        meter_(view, tree.ellipsoid(), relief_ != nullptr),
        first_({.tree = &tree, .texels_per_pixel = options.texels_per_pixel, .max_tile_level = options.max_tile_level},
               options, meter_) {
    for (const FurtherImagery& imagery : further) further_.emplace_back(imagery, options, meter_);
  }

  void visit(const PatchNode& node, bool inside) {
    if (horizon_.hides(node)) return;
    if (!inside) {
      const int side = classify(planes_, view_, node.sphere);
      if (side < 0) return;
      inside = side > 0;
    }
    const PatchSight sight = meter_.measure(node);
    if (is_coarse(node, sight)) return split(node, inside);
    const SelectedPatch patch = first_.choose_level(node, sight);
    if (needs_split(node, sight, patch)) return split(node, inside);
    emit(patch, inside);
  }

  // Splits leaves until no neighbour in view is more than one level apart, and notes the coarse sides. A pass that
  // splits nothing has noted all of them.
  void balance() {
    for (bool changed = true; changed;) {
      changed = false;
      for (std::size_t k = 0; k < out_.size(); ++k) changed = meet_neighbours(k) || changed;
      if (changed) std::erase_if(out_, [this](const SelectedPatch& p) { return !growth_.is_leaf(*p.node); });
    }
  }

  // Lists the selected patches again, for each further grid.
  void select_further() {
    for (const ImageryFit& fit : further_) {
      for (const SelectedPatch& patch : out_) {
        const PatchSight sight = meter_.measure(*patch.node);
        const PatchNode* node = fit.node_of(*patch.node, sight);
        if (node == nullptr) continue;
        SelectedPatch& also = fit.imagery().out->emplace_back(fit.choose_level(*node, sight));
        also.coarse_sides = patch.coarse_sides;
        also.cut_by_view = patch.cut_by_view;
        also.surface = patch.node;
      }
    }
  }

 private:
  // True if the mesh would show as one, whatever is drawn on it. The first level has the antimeridian on its borders.
  [[nodiscard]] bool is_coarse(const PatchNode& node, const PatchSight& sight) const {
    if (node.id.level < 1) return true;
    return node.id.level < kMaxPatchLevel &&
           node.geometric_error_m * meter_.corner_px_per_rad() / sight.nearest_m > options_.max_error_px;
  }

  [[nodiscard]] bool needs_split(const PatchNode& node, const PatchSight& sight, const SelectedPatch& patch) {
    if (node.id.level >= kMaxPatchLevel) return false;
    return is_too_long(node, sight) || first_.needs_split(node, sight, patch) ||
           follows_ground_badly(node, sight, patch) || std::ranges::any_of(further_, [&](const ImageryFit& fit) {
             const PatchNode* own = fit.node_of(node, sight);
             return own != nullptr && fit.needs_split(node, sight, fit.choose_level(*own, sight));
           });
  }

  // An eye among the heights of relief may be in the sphere of a patch that is far away.
  [[nodiscard]] bool is_too_long(const PatchNode& node, const PatchSight& sight) const {
    const double radius_m = node.relief.flat.radius_m;
    const double least_m = sight.distance_m > 1.5 * radius_m ? 0.2 * sight.distance_m : options_.clearance_m;
    const double pixel_m = std::max(sight.nearest_m, least_m) * meter_.radians_per_pixel();
    return radius_m * std::numbers::sqrt2 > options_.most_patch_px * pixel_m;
  }

  // Heights move points along the normal: seen from above they move less on the screen. Without a mesh the error is
  // unknown, and the patch stays as it is until it has one.
  [[nodiscard]] bool follows_ground_badly(const PatchNode& node, const PatchSight& sight, const SelectedPatch& patch) {
    if (relief_ == nullptr || node.id.level >= kMostReliefLevel) return false;
    // A child's side is half the patch's, which is √2 of its radius.
    const double child_side_m = node.relief.flat.radius_m * (0.5 * std::numbers::sqrt2);
    if (child_side_m < kLeastSegment_px * tree_.segments() * patch.pixel_m) return false;
    if (want_mesh(node)) ++plan_.undecided;
    if (node.relief.heights_m.empty()) return false;
    const double flat = std::sqrt(std::max(0.0, 1.0 - sight.up * sight.up));
    const double sine = std::min(1.0, flat + node.sphere.radius_m / sight.distance_m);
    const double error_px = node.relief.error_m * sine * meter_.corner_px_per_rad() / sight.nearest_m;
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

  // False, and counted, if the children have no meshes and the budget is spent: the patch is drawn for one more frame.
  // Meshes of patches that must be drawn are made in any case.
  [[nodiscard]] bool may_split(const PatchNode& node) {
    const PatchFamily* family = growth_.known_children(node);
    const auto has_no_mesh = [](const PatchNode* child) { return child->relief.heights_m.empty(); };
    if (meshes_left_ > 0 || (family != nullptr && std::ranges::none_of(*family, has_no_mesh))) return true;
    ++plan_.put_off;
    return false;
  }

  void split(const PatchNode& node, bool inside) {
    growth_.mark_split(node);
    for (const PatchNode* child : growth_.children(node)) visit(*child, inside);
  }

  void emit(const SelectedPatch& patch, bool inside) {
    growth_.mark_leaf(*patch.node);
    if (relief_ != nullptr) want_mesh(*patch.node);
    out_.push_back(patch);
    out_.back().cut_by_view = !inside || horizon_.may_cut(*patch.node);
  }

  // The leaf that covers the neighbour across a side. None if finer patches are there, or nothing is drawn: the
  // selection visited a node only if it split the node's parent.
  [[nodiscard]] const PatchNode* leaf_beside(const PatchNode& node, PatchSide side) const {
    const PatchNode* other = &growth_.beside(node, side);
    while (other->parent != nullptr && !growth_.is_split(*other->parent)) other = other->parent;
    return growth_.is_leaf(*other) ? other : nullptr;
  }

  // True if it split a neighbour. Otherwise the patch knows its coarse sides.
  bool meet_neighbours(std::size_t k) {
    const PatchNode& node = *out_[k].node;
    if (!growth_.is_leaf(node)) return false;
    bool changed = false;
    unsigned coarse = 0;
    for (int side = 0; side < 4; ++side) {
      const PatchNode* other = leaf_beside(node, static_cast<PatchSide>(side));
      if (other == nullptr || other->id.level >= node.id.level) continue;
      coarse |= 1U << side;
      if (other->id.level == node.id.level - 1) continue;
      split(*other, false);
      changed = true;
    }
    out_[k].coarse_sides = coarse;
    return changed;
  }

  const PatchTree& tree_;
  const Relief* relief_;
  int meshes_left_;
  TreeGrowth& growth_;
  const View& view_;
  const PatchSelectionOptions& options_;
  PatchSelection& plan_;
  std::vector<SelectedPatch>& out_;
  ViewPlanes planes_;
  Horizon horizon_;
  SightMeter meter_;
  ImageryFit first_;
  std::vector<ImageryFit> further_;
};

bool finite(const View& view) {
  const glm::dvec3 all = view.eye.xyz_m + view.right + view.up + view.forward;
  return std::isfinite(all.x + all.y + all.z + view.tan_half_fov_y);
}

}  // namespace

PatchSelection plan_patches(const PatchTree& tree, TreeGrowth& growth, const View& view,
                            const PatchSelectionOptions& options, std::span<const FurtherImagery> further,
                            PatchSelection recycled) {
  PatchSelection plan{.patches = std::move(recycled.patches), .meshes = std::move(recycled.meshes)};
  plan.patches.clear();
  plan.meshes.clear();
  for (const FurtherImagery& imagery : further) imagery.out->clear();
  if (!finite(view)) return plan;
  growth.clear_selection();
  Selector selector(tree, growth, view, options, plan, further);
  for (int f = 0; f < kCubeFaces; ++f) selector.visit(tree.root(static_cast<CubeFace>(f)), false);
  selector.balance();
  selector.select_further();
  return plan;
}

void select_patches(PatchTree& tree, const View& view, PatchSelectionOptions options, std::vector<SelectedPatch>& out) {
  if (options.relief != nullptr) options.relief->refresh_bounds(tree);
  TreeGrowth growth;
  PatchSelection plan{.patches = std::move(out), .meshes = {}};
  do {
    growth.begin(tree, options.relief);
    plan = plan_patches(tree, growth, view, options, {}, std::move(plan));
    tree.adopt(growth);
    if (options.relief != nullptr) options.mesh_budget -= options.relief->make_meshes(tree, plan.meshes);
  } while (plan.undecided > 0);
  out = std::move(plan.patches);
}

}  // namespace terrella
