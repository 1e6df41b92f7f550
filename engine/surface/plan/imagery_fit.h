#pragma once

#include <cmath>

#include "surface/plan/patch_selection.h"
#include "surface/plan/patch_sight.h"

namespace terrella {

/// Chooses the tile level of patches for one imagery, and decides which patches do not suit it. `node` is a node of the
/// imagery's tree. `sight` and `body` are those of the same patch in the lowest layer's tree. thread: any
class ImageryFit {
 public:
  ImageryFit(const FurtherImagery& imagery, const PatchSelectionOptions& options, const SightMeter& meter);

  [[nodiscard]] const FurtherImagery& imagery() const { return imagery_; }
  /// The node of a patch; none if the imagery is not drawn there.
  [[nodiscard]] const PatchNode* node_of(const PatchNode& body, const PatchSight& sight) const;
  /// The patch with its tile level, and with SelectedPatch::in_band.
  [[nodiscard]] SelectedPatch choose_level(const PatchNode& node, const PatchSight& sight) const;
  /// True if the patch is too large for its texture coordinates, its window or its nearest pixels.
  [[nodiscard]] bool needs_split(const PatchNode& body, const PatchSight& sight, const SelectedPatch& patch) const;

 private:
  /// A pixel on the ground at the patch's centre.
  struct Footprint {
    double east_m, north_m;
  };
  [[nodiscard]] Footprint footprint(const PatchNode& node, const PatchSight& sight) const;
  /// Cosine of the slant that the patch's level suits.
  [[nodiscard]] double facing(const PatchSight& sight) const;
  [[nodiscard]] double pixel_m(const PatchSight& sight) const;
  /// True if interpolated texture coordinates are off by more than they may be.
  [[nodiscard]] bool is_bent(const PatchNode& node, const PatchSight& sight) const;
  [[nodiscard]] bool in_band(const PatchNode& node) const { return node.min_colatitude_rad < band_rad_; }
  [[nodiscard]] double texel0_m(const PatchNode& node) const { return equator_texel0_m_ * node.row_stretch; }
  /// Height of a texel of the patch's level.
  [[nodiscard]] double texel_m(const PatchNode& node, const SelectedPatch& patch) const {
    return std::ldexp(texel0_m(node), -patch.tile_level);
  }
  /// Longest extent of a pixel, in texels of the patch's level at a colatitude.
  [[nodiscard]] double longest_texels(const PatchNode& node, const Footprint& pixel, const SelectedPatch& patch,
                                      double colatitude_rad) const;
  [[nodiscard]] static int wanted_level(double texel0_m, double pixel_m);
  [[nodiscard]] static bool touches_pole(const PatchNode& node) { return node.min_colatitude_rad == 0.0; }
  [[nodiscard]] bool is_worth_a_split(const PatchNode& body, const PatchSight& sight, const SelectedPatch& patch) const;
  [[nodiscard]] bool reaches_to_the_eye(const PatchSight& sight, const SelectedPatch& patch) const;
  [[nodiscard]] bool window_too_wide(const SelectedPatch& patch) const;

  FurtherImagery imagery_;
  const PatchSelectionOptions& options_;
  const SightMeter& meter_;
  double equator_texel0_m_;  ///< height of a texel of level 0
  double band_rad_;
  int finest_level_;
};

}  // namespace terrella
