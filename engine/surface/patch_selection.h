#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geo/camera.h"
#include "surface/patch_tree.h"
#include "surface/tree_growth.h"
#include "view/render_modes.h"

namespace terrella {

/// Longest pixel, in texels, on which a plain patch is drawn with three taps (shaders/surface/patch_plain.frag).
/// Selection takes a coarser level before pixels get longer, but beside the poles. The error grows with the length: for
/// imagery whose amplitudes fall as 1/frequency and whose contrast is 30 levels of 8 bits, the RMS over a pixel 1 texel
/// wide is 1.5 levels at a length of 3 texels, 3.6 at 8 and 5.0 at 12 (tests/scene/footprint_test.cpp). Ten taps would
/// have 1.0.
constexpr double kPlainFootprint_texels = 12.0;

struct PatchSelectionOptions {
  double max_error_px = 0.2;      ///< of the surface, and of interpolated texture coordinates
  double band = 0.05;             ///< a pole band is this part of the picture's height (paper 1, 1.5)
  double texels_per_pixel = 1.0;  ///< detail asked of the imagery: 1, a texel a pixel along the meridian
  double max_footprint_texels = kPlainFootprint_texels;  ///< longest pixel outside pole bands
  int max_window = 8;                                    ///< a patch whose window has more cells a side is split
  int max_polar_columns = 32;  ///< a patch that touches a pole takes a coarser level over this many columns
  HorizonCulling horizon_culling = HorizonCulling::automatic;
  double inner_sphere_m = 0.0;         ///< radius of what hides the far side from an eye under the ground; 0: nothing
  int max_tile_level = kMaxTileLevel;  ///< no finer tiles than these, whatever the grid has
};

/// One patch to draw.
struct SelectedPatch {
  const PatchNode* node = nullptr;
  int tile_level = 0;         ///< of its window
  bool squeezed = true;       ///< takes squeezed tiles where there are any, at that level; else those of the full grid
  int squeeze = 0;            ///< of its window
  unsigned coarse_sides = 0;  ///< bit k: the neighbour across PatchSide k is one level coarser
  bool in_band = false;       ///< needs per-fragment coordinates
  bool cut_by_view = false;   ///< part of it may be out of view: its cells are worth testing one by one
  double pixel_m = 1.0;       ///< what a pixel covers on its nearest part, across the line of sight
  double footprint_texels = 1.0;       ///< longest extent of a pixel on the patch, in texels of tile_level, estimated
  const PatchNode* surface = nullptr;  ///< of further imagery: the node of the first tree that it lies on

  /// The node that knows the patch's bounds.
  [[nodiscard]] const PatchNode& body() const { return surface != nullptr ? *surface : *node; }
};

/// Tiles of another grid over the same patches.
struct FurtherImagery {
  const PatchTree* tree = nullptr;  ///< of the same body, tessellation and relief
  TreeGrowth* growth = nullptr;     ///< of that tree
  double texels_per_pixel = 1.0;    ///< as PatchSelectionOptions has it
  int least_level = 0;              ///< patches whose view asks for coarser tiles are left out
  int max_tile_level = kMaxTileLevel;
  std::vector<SelectedPatch>* out = nullptr;  ///< of the patches selected those that touch the grid's bounds
};

/// The four side planes of the view, for spheres: dot(normal, p - eye) ≥ -radius is (partly) inside.
struct ViewPlanes {
  std::array<glm::dvec3, 4> normals;
};
[[nodiscard]] ViewPlanes view_planes(const View& view);
/// -1 outside, 0 cut, 1 inside.
[[nodiscard]] int classify(const ViewPlanes& planes, const View& view, const BoundingSphere& sphere);

/// Result of a selection.
struct PatchSelection {
  std::vector<SelectedPatch> patches;
  std::vector<const PatchNode*> meshes;  ///< of relief, to be made before the patches are drawn
  int put_off = 0;    ///< patches drawn coarser than their relief asks for, as the budget of meshes is spent
  int undecided = 0;  ///< patches of which nothing or nothing new is known until their meshes are made
};

/// What a frame draws: patches that tile the visible surface, neighbours at most one level apart. A function of the
/// view, the tree and the options: nodes missing from the tree are made in the growths, and no mesh is made. An eye
/// under the surface sees every patch in front of it that the inner sphere does not hide. A view with NaN selects
/// nothing. Further imagery takes part in what is split: each patch suits all grids. thread: any
[[nodiscard]] PatchSelection plan_patches(const PatchTree& tree, TreeGrowth& growth, const View& view,
                                          const PatchSelectionOptions& options,
                                          std::span<const FurtherImagery> further = {});

/// Plans until every patch is decided, makes the meshes and lets the tree adopt what was made. thread: main
void select_patches(PatchTree& tree, const View& view, const PatchSelectionOptions& options,
                    std::vector<SelectedPatch>& out);

}  // namespace terrella
