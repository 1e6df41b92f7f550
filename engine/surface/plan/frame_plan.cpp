#include "surface/plan/frame_plan.h"

#include <algorithm>
#include <random>
#include <utility>

namespace terrella {
namespace {

// Steps by a quarter in which detail gives way to the budget: six tile levels.
constexpr int kMostCoarser = 16;

std::vector<FurtherImagery> further_imagery(const FrameSnapshot& snapshot, FramePlan& plan) {
  std::vector<FurtherImagery> further;
  for (std::size_t k = 1; k < snapshot.layers.size(); ++k) {
    const LayerSnapshot& layer = snapshot.layers[k];
    further.push_back({.tree = layer.tree,
                       .growth = &plan.layers[k].growth,
                       .texels_per_pixel = layer.texels_per_pixel * plan.layers[k].detail,
                       .least_level = layer.least_level,
                       .max_tile_level = layer.max_tile_level,
                       .out = &plan.layers[k].patches});
  }
  return further;
}

void plan_all_patches(const View& view, const FrameSnapshot& snapshot, PatchSelectionOptions& options,
                      FramePlan& plan) {
  const LayerSnapshot& first = snapshot.layers.front();
  options.texels_per_pixel = first.texels_per_pixel * plan.layers.front().detail;
  options.max_tile_level = first.max_tile_level;
  std::vector<SelectedPatch>& patches = plan.layers.front().patches;
  PatchSelection selection =
      plan_patches(*first.tree, plan.layers.front().growth, view, options, further_imagery(snapshot, plan),
                   {.patches = std::move(patches), .meshes = std::move(plan.meshes)});
  plan.meshes = std::move(selection.meshes);
  plan.put_off = selection.put_off + selection.undecided;
  patches = std::move(selection.patches);
  if (snapshot.patch_shuffle) std::ranges::shuffle(patches, std::mt19937(*snapshot.patch_shuffle));
}

// Patches on which nothing of the layer shows.
void leave_out_other_side(const LayerSnapshot& layer, const glm::dvec3& sun, std::vector<SelectedPatch>& patches) {
  if (layer.daylight == Daylight::both) return;
  std::erase_if(patches, [&](const SelectedPatch& patch) {
    return !may_show(layer.daylight, *patch.node, layer.tree->ellipsoid(), sun);
  });
}

std::optional<ShadowCast> shadow_of(const FrameSnapshot& snapshot, std::size_t layer) {
  const double height_m = snapshot.layers[layer].height_m;
  if (layer == 0 || height_m <= 0.0 || !snapshot.light) return std::nullopt;
  return ShadowCast{height_m, *snapshot.light};
}

void plan_tiles(const View& view, const FrameSnapshot& snapshot, const PatchSelectionOptions& options,
                FramePlan& plan) {
  for (std::size_t k = 0; k < plan.layers.size(); ++k) {
    const LayerSnapshot& layer = snapshot.layers[k];
    LayerPlan& out = plan.layers[k];
    if (k > 0 && snapshot.sun) leave_out_other_side(layer, *snapshot.sun, out.patches);
    cover_with_tiles({.tree = *layer.tree,
                      .growth = out.growth,
                      .view = view,
                      .patches = out.patches,
                      .residency = *layer.tiles,
                      .texels_per_pixel = layer.texels_per_pixel * out.detail,
                      .out_of_bounds = k == 0 ? OutOfBounds::ancestor : OutOfBounds::nothing,
                      .has_relief = options.relief != nullptr,
                      .columns_beside = k == 0 && options.columns_beside,
                      .shadow = shadow_of(snapshot, k)},
                     out.coverage);
  }
}

bool is_coarsest(const LayerSnapshot& layer, const LayerPlan& plan) {
  return std::ranges::all_of(plan.patches, [coarsest = layer.tree->grid().min_level](const SelectedPatch& patch) {
    return patch.tile_level == coarsest;
  });
}

// True if a layer's view wants more tiles than there is room for, and there are coarser ones.
bool coarsen(const FrameSnapshot& snapshot, FramePlan& plan) {
  bool coarser = false;
  for (std::size_t k = 0; k < plan.layers.size(); ++k) {
    const bool fits = plan.layers[k].coverage.tiles <= snapshot.layers[k].room;
    if (fits || is_coarsest(snapshot.layers[k], plan.layers[k])) continue;
    plan.layers[k].detail *= 0.75;
    coarser = true;
  }
  return coarser;
}

}  // namespace

// A view that wants more tiles than there is room for is drawn a little coarser rather than never finished.
FramePlan plan_frame(const View& view, const FrameSnapshot& snapshot, PatchSelectionOptions options,
                     FramePlan recycled) {
  FramePlan plan = std::move(recycled);
  plan.layers.resize(snapshot.layers.size());
  for (std::size_t k = 0; k < plan.layers.size(); ++k) {
    plan.layers[k].growth.begin(*snapshot.layers[k].tree, options.relief);
    plan.layers[k].detail = snapshot.layers[k].detail;
  }
  for (int step = 0; step <= kMostCoarser; ++step) {
    plan_all_patches(view, snapshot, options, plan);
    plan_tiles(view, snapshot, options, plan);
    if (!coarsen(snapshot, plan)) break;
  }
  return plan;
}

}  // namespace terrella
