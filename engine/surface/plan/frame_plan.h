#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "surface/daylight.h"
#include "surface/plan/patch_selection.h"
#include "surface/plan/tile_coverage.h"
#include "surface/tree_growth.h"

namespace terrella {

/// One image layer as a plan reads it.
struct LayerSnapshot {
  const PatchTree* tree = nullptr;  ///< tree with the body, tessellation and relief of the other layers' trees
  const TileResidency* tiles = nullptr;
  double texels_per_pixel = 1.0;                      ///< at full detail
  double detail = 1.0;                                ///< part of texels_per_pixel that the last frame had room for
  int room = std::numeric_limits<int>::max();         ///< tiles of a view that fit the layer's budget
  int least_level = std::numeric_limits<int>::min();  ///< patches whose view asks for coarser tiles are left out
  int max_tile_level = kMaxTileLevel;
  Daylight daylight = Daylight::both;  ///< side of the planet on which the layer shows
  double height_m = 0.0;               ///< over the ground
};

/// All that a plan reads besides the view: the layers that the frame draws, the lowest first. The trees' bounds must be
/// up to date (Relief::refresh_bounds()).
struct FrameSnapshot {
  std::vector<LayerSnapshot> layers;
  std::optional<glm::dvec3> sun;          ///< direction; none: there is no night
  std::optional<glm::dvec3> light = {};   ///< direction that shadows are thrown from; none: there are none
  std::optional<unsigned> patch_shuffle;  ///< seed of an order in which the lowest layer's patches are drawn
};

/// Plan of one layer: the frame's draws, and the changes that executing the plan makes.
struct LayerPlan {
  std::vector<SelectedPatch> patches;
  TileCoverage coverage;
  TreeGrowth growth;
  double detail = 1.0;
  bool operator==(const LayerPlan&) const = default;
};

/// Plan of a frame: patches, tiles and meshes to draw and to request.
struct FramePlan {
  std::vector<LayerPlan> layers;  ///< as the snapshot's
  std::vector<NodeRef> meshes;    ///< PatchSelection::meshes
  int put_off = 0;                ///< patches drawn coarser than their relief asks for, for now
  bool operator==(const FramePlan&) const = default;
};

/// Decides what a frame draws. Changes nothing: nodes and windows that the trees do not have are made in the plan, and
/// uses of tiles are listed in the plan. A view that wants more tiles than a layer has room for takes less detail.
/// `options` are those of the lowest layer, but for texels_per_pixel and max_tile_level, which the snapshot tells.
/// `recycled`: an old plan, whose memory is used again. Several threads may plan from one snapshot at once while
/// nothing changes it. thread: any
[[nodiscard]] FramePlan plan_frame(const View& view, const FrameSnapshot& snapshot, PatchSelectionOptions options,
                                   FramePlan recycled = {});

}  // namespace terrella
