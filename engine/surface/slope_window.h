#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "surface/relief.h"

namespace terrella {

/// The tiles of heights of one level under a patch, for the light on its relief: columns x0…x0+w-1, rows y0…y0+h-1.
struct SlopeWindow {
  int level = 0;
  std::int64_t x0 = 0, y0 = 0;
  int w = 1, h = 1;
  glm::vec4 center_and_scale{0.0F};  ///< as PatchDraw has it, in the rows of the heights' grid
};

/// Chooses the level whose heights are 1 to 2 pixels apart, also beyond the grid's finest (HeightField::slopes()). A
/// patch at a slant takes a coarser level, so that heights do not flicker. thread: any, while nothing changes the
/// relief
[[nodiscard]] SlopeWindow slope_window(const Relief& relief, const PatchTree& tree, const SelectedPatch& patch);

/// Longitudes and row latitudes of the heights' grid at the vertices of a patch, relative to its centre, degrees, in
/// the order of patch_vertices(). thread: any
[[nodiscard]] std::vector<glm::vec2> height_offsets_deg(const TileGrid& heights, const PatchTree& tree,
                                                        const PatchNode& node);

}  // namespace terrella
