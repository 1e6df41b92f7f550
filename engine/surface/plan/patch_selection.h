#pragma once

#include <limits>
#include <span>
#include <vector>

#include "geo/camera.h"
#include "surface/selected_patch.h"
#include "surface/tree_growth.h"
#include "view/render_modes.h"

namespace terrella {

/// Longest pixel, in texels, on which a plain patch is drawn with three taps (shaders/surface/patch_plain.frag).
/// Selection takes a coarser level before pixels get longer, but beside the poles. The error grows with the length. For
/// imagery whose amplitudes fall as 1/frequency and whose contrast is 30 levels of 8 bits, a pixel 1 texel wide has an
/// RMS of 1.5 levels at a length of 3 texels. The RMS is 3.6 at 8 texels and 5.0 at 12
/// (tests/scene/footprint_test.cpp). Ten taps would have 1.0.
constexpr double kPlainFootprint_texels = 12.0;

class Relief;

struct PatchSelectionOptions {
  double max_error_px = 0.2;      ///< largest error of the surface, and of interpolated texture coordinates
  double band = 0.05;             ///< a pole band is this part of the picture's height (paper 1, 1.5)
  double texels_per_pixel = 1.0;  ///< detail asked of the imagery: 1, a texel a pixel along the meridian
  double max_footprint_texels = kPlainFootprint_texels;  ///< longest pixel outside pole bands
  /// A pixel that the slant makes n times as long as wide asks for texels of its width times n to this power.
  double slant_power = 0.5;
  bool columns_beside = false;                                     ///< as CoverInput has it, for the lowest layer
  double most_patch_px = std::numeric_limits<double>::infinity();  ///< a patch with a longer side is split
  double clearance_m = 0.0;    ///< least distance of the ground from the eye, for most_patch_px
  int max_window = 8;          ///< a patch whose window has more cells a side is split
  int max_polar_columns = 32;  ///< a patch that touches a pole takes a coarser level over this many columns
  HorizonCulling horizon_culling = HorizonCulling::automatic;
  double inner_sphere_m = 0.0;         ///< radius of the sphere that hides the far side from an eye below; 0: none
  int max_tile_level = kMaxTileLevel;  ///< no finer tiles than these, whatever the grid has
  const Relief* relief = nullptr;      ///< the ground that patches follow; none: the ellipsoid
  int mesh_budget = std::numeric_limits<int>::max();  ///< new meshes of relief before patches are put off
};

/// Tiles of another grid over the same patches.
struct FurtherImagery {
  const PatchTree* tree = nullptr;  ///< tree with the same body, tessellation and relief
  TreeGrowth* growth = nullptr;     ///< growth of that tree
  double texels_per_pixel = 1.0;    ///< as PatchSelectionOptions has it
  int least_level = 0;              ///< patches whose view asks for coarser tiles are left out
  int max_tile_level = kMaxTileLevel;
  std::vector<SelectedPatch>* out = nullptr;  ///< result: the selected patches that touch the grid's bounds
};

/// Result of a selection.
struct PatchSelection {
  std::vector<SelectedPatch> patches;
  std::vector<NodeRef> meshes;  ///< relief meshes to make before the patches are drawn
  int put_off = 0;              ///< patches drawn coarser than their relief asks for, as the budget of meshes is spent
  int undecided = 0;            ///< patches whose relief is unknown or out of date until their meshes are made
};

/// Selects the patches of a frame: they tile the visible surface, and neighbours are at most one level apart. A
/// function of the view, the trees, the relief and the options: nodes that the trees do not have are made in the
/// growths, and no mesh is made. An eye under the surface sees every patch in front of it that the inner sphere does
/// not hide. A view with NaN selects nothing. Further imagery takes part in what is split: each patch suits all grids.
/// `recycled`: an old selection, whose memory is used again. thread: any
[[nodiscard]] PatchSelection plan_patches(const PatchTree& tree, TreeGrowth& growth, const View& view,
                                          const PatchSelectionOptions& options,
                                          std::span<const FurtherImagery> further = {}, PatchSelection recycled = {});

/// Plans until every patch is decided, makes the meshes and lets the tree adopt the growth. thread: main
void select_patches(PatchTree& tree, const View& view, PatchSelectionOptions options, std::vector<SelectedPatch>& out);

}  // namespace terrella
