#pragma once

#include <cstdint>
#include <vector>

#include "geo/camera.h"
#include "surface/plan/patch_selection.h"

namespace terrella::bench {

/// Errors of a mesh over the visible triangles that face the eye with an incidence under 81°. Samples are corners, edge
/// middles and centres. The truth is this folder's own (truth/spheroid.h).
struct MeshError {
  double position_px = 0.0;  ///< greatest distance between a place's drawn and true positions
  double position_rms_px = 0.0;
  double texture_texels = 0.0;  ///< greatest ground distance between the place drawn at a pixel and the true place,
                                ///< divided by the height of a texel of the patch's tile level
  double silhouette_px = 0.0;   ///< greatest distance of the mesh's outline from the limb; 0 if the limb is out of view
};

/// Drawn patches and triangles, and those that no picture needs.
struct MeshCount {
  std::int64_t patches = 0, triangles = 0;
  std::int64_t needless_patches = 0;    ///< patches without a needed triangle
  std::int64_t needless_triangles = 0;  ///< triangles out of the picture, or facing away behind the horizon
};

/// Measures selected patches as the globe draws them with `vertex` texturing. With `exact_bands`, patches in the pole
/// bands use interpolated directions, as with `automatic`. Only for equirectangular grids that count geodetic latitude.
/// thread: main
[[nodiscard]] MeshError mesh_error(const PatchTree& tree, const View& view, const Camera& camera,
                                   const std::vector<SelectedPatch>& patches, bool exact_bands);
[[nodiscard]] MeshCount mesh_count(const PatchTree& tree, const View& view, const std::vector<SelectedPatch>& patches);

}  // namespace terrella::bench
