#pragma once

#include <cstdint>
#include <vector>

#include "geo/camera.h"
#include "surface/patch_selection.h"

namespace terrella::bench {

/// How far what a mesh shows is from where it belongs, over the triangles that face the eye in the picture, seen at
/// less than 81°. Corners, edge middles and centres are looked at; the truth is this folder's own (truth/spheroid.h).
struct MeshError {
  double position_px = 0.0;  ///< greatest distance between where a place is drawn and where it is seen
  double position_rms_px = 0.0;
  double texture_texels = 0.0;  ///< greatest distance on the ground between the place drawn at a pixel and the place
                                ///< seen through it, over the height of a texel of the patch's tile level
  double silhouette_px = 0.0;   ///< greatest distance of the mesh's outline from the limb; 0 if that is out of view
};

/// What was drawn that no picture needs.
struct MeshCount {
  std::int64_t patches = 0, triangles = 0;
  std::int64_t needless_patches = 0;    ///< without a triangle that is needed
  std::int64_t needless_triangles = 0;  ///< out of the picture, or facing away: behind the horizon
};

/// Of the patches that a selection has chosen, as the globe draws them with `vertex` texturing; with `exact_bands`, as
/// with `automatic`: patches in the pole bands have their coordinates from interpolated directions. For grids that are
/// equirectangular and count geodetic latitude. thread: main
[[nodiscard]] MeshError mesh_error(const PatchTree& tree, const View& view, const Camera& camera,
                                   const std::vector<SelectedPatch>& patches, bool exact_bands);
[[nodiscard]] MeshCount mesh_count(const PatchTree& tree, const View& view, const std::vector<SelectedPatch>& patches);

}  // namespace terrella::bench
