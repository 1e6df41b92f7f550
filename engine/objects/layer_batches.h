#pragma once

#include <array>
#include <memory>
#include <vector>

#include "objects/ground/ground_batch.h"
#include "objects/slot_batch.h"
#include "objects/sphere_groups.h"

namespace terrella {

/// Fills of one bucket with the same height that are contiguous.
struct FillRun {
  double height_m = 0.0;
  std::size_t first = 0, count = 0;  ///< indices
};

/// The spheres of a layer. They are sorted anew when one is added or removed, and moved in place.
struct SphereBatch {
  SphereGroups groups;
  Batch<char> ranges;
  ChangedRanges changed;
  bool stale = false;  ///< to be sorted anew
};

/// The places of one model in a layer.
struct ModelStands {
  std::shared_ptr<const MeshModel> model;
  double reach_m = 0.0;  ///< radius of a ball that contains the model
  SlotBatch<MeshStand> stands;
};

/// All objects of a layer but labels, in the layout for the GPU. The renderer uploads what has changed.
struct LayerBatches {
  SphereBatch spheres;
  SlotBatch<DotInstance> markers;  ///< discs
  SlotBatch<IconInstance> icons;
  std::vector<std::shared_ptr<const IconImage>> icon_images;
  float icons_below_px = 0.0F;    ///< the most that an icon reaches down from its place
  SlotBatch<LineVertex> casings;  ///< borders of lines, below all lines
  SlotBatch<LineVertex> lines;    ///< n vertices contain n - 3 pieces
  SlotBatch<FillVertex> fill_vertices;
  SlotBatch<std::uint32_t> fill_indices;
  std::array<std::vector<FillRun>, Batch<char>::kBuckets> fill_runs;  ///< per bucket of fill_indices
  std::uint64_t fill_version = 0;                                     ///< counts changes of fill_runs
  SlotBatch<SolidVertex> solids;                                      ///< extruded areas: corners of triangles
  std::vector<ModelStands> models;
  GroundBatch ground;  ///< lines and areas that lie on the ground
};

}  // namespace terrella
